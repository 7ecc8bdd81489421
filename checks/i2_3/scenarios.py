"""I2.3: what is done to the node."""

from __future__ import annotations

import asyncio
import contextlib
import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from checks.i2_3.facts import (
    ANSWER_S,
    CALLS,
    EXCUSED_S,
    FILE,
    LONGEST_S,
    SERVICE,
    SHORTEST_S,
    TYPE,
    WORK_S,
    Call,
    CallBatch,
    ConcurrentCalls,
    IdleRun,
    Interrupted,
    SingleCalls,
    has_service,
    is_disturbed,
    is_excused,
    right_sum,
)
from checks.i2_3.listening import listen, logs_since, may_be_10_hz, next_tick
from checks.i2_3.repeats import MOST_TRIES, TRIES, needs_repeat, needs_repeat_at_once
from checks.i2_3.ticks import Series, all_series, timer_series
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import repeat_if_doubtful
from tutor.judge.trace import CallAnswer
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting import CPU_WAIT_SHARE, IDLE_S, wait_until_seen

INTO_CALL_S = 1.5
"""A call that was made this long ago is being worked on."""

IN_GRAPH_S = 1.0
"""All services of a node are in the graph this much later than the first sign of it."""

SPINS_S = 2.5
"""A node whose service is there spins at the latest twice this later, or never."""

APART_S = 0.1
"""Of three calls at once, the last is made this much later, so that answers in another order mean something."""


@repeat_if_doubtful
async def run_idle(bench: Bench) -> IdleRun:
    """Listen to the node while nobody calls, then press Ctrl+C."""
    async with bench.start(FILE) as run:  # first, like `call_singly`, which waits for it
        bench.report_progress(0.1, "waiting for the timer's log messages")
        await wait_until_seen(run, lambda: bool(run.graph.nodes))
        up_at = run.now()
        may_tick = await _spins(run) or bool(logs_since(run.logs, up_at))  # a timer needs a node that spins
        since = run.now()
        if may_tick:
            await wait_until_seen(run, lambda: bool(logs_since(run.logs, since)), idle_s=IDLE_S)
        listened_at, cpu_wait_s = run.now(), run.node_cpu_wait_s()
        bench.report_progress(0.3, "listening to the timer")
        if may_tick:
            await listen(run, since, lambda: has_service(run.graph.servers))
        share = (run.node_cpu_wait_s() - cpu_wait_s) / max(0.1, run.now() - listened_at)
        series = timer_series(all_series(logs_since(run.logs, since)))
        busy = share >= CPU_WAIT_SHARE and any(may_be_10_hz(each, share) for each in series if not each.is_10_hz)
        idle = IdleRun(run.trace(), series, busy)
        bench.report_progress(0.8, "pressing Ctrl+C")
        return replace(idle, ending=await run.interrupt() if run.exit is None else None)


async def call_singly(bench: Bench) -> SingleCalls:
    """Call the service, then once more, and watch the timer meanwhile and until it is seen again."""
    looking: list[asyncio.Task[tuple[tuple[Frame, ...], bool]]] = []

    def suspect(answers: bool) -> None:
        looking.append(asyncio.ensure_future(_stuck(bench, answers=answers)))

    try:
        seen, well = await _call_singly(bench, suspect)
        if seen.calls and seen.trace.exit is None and not well:
            answers = seen.calls[-1].answer.response is not None
            stuck, spins = await (looking[-1] if looking else _stuck(bench, answers=answers))
            return replace(seen, stuck=stuck, spins=spins)
        return seen
    finally:
        for task in looking:
            task.cancel()
        await asyncio.gather(*looking, return_exceptions=True)


async def _call_singly(bench: Bench, suspect: Callable[[bool], None]) -> tuple[SingleCalls, bool]:
    """The calls, and whether there was nothing wrong with the first.

    `suspect` is called as soon as there may be, with whether the node answers.
    """
    async with bench.start(FILE) as run:
        bench.report_progress(0.1, f"waiting for {SERVICE}")
        if not await _is_served(run):
            return SingleCalls(run.trace()), False
        if not (spins := await _spins(run)):
            suspect(False)
        bench.report_progress(0.2, f"calling {SERVICE}")
        second: list[asyncio.Task[_Made]] = []
        try:
            calls, well = await _call_first(bench, run, suspect, second, _answer_limit_s(spins))
            later: Sequence[Call] = ()
            idle = await bench.facts(run_idle)
            bench.report_facts(SingleCalls(run.trace(), tuple(calls), idle=idle))
            if well and run.exit is None:
                bench.report_progress(0.6, f"calling {SERVICE} once more, with large numbers")
                later = await _call_again(run, idle.series, *second)
        finally:
            for task in second:
                task.cancel()
            await asyncio.gather(*second, return_exceptions=True)
        return SingleCalls(run.trace(), tuple(calls), later=tuple(later)), well


_Made = tuple[CallAnswer, float]
"""A call's answer, and the seconds in which the machine kept the node or us from running meanwhile."""


async def _make_call(run: Run, operands: Mapping[str, int], limit_s: float) -> _Made:
    lost_s = _lost_s(run)
    answer = await run.call(SERVICE, TYPE, operands, limit_s=limit_s)
    return answer, _lost_s(run) - lost_s


async def _call_first(
    bench: Bench,
    run: Run,
    suspect: Callable[[bool], None],
    second: list[asyncio.Task[_Made]],
    limit_s: float,
) -> tuple[list[Call], bool]:
    """Make a call, and again where a busy machine leaves it in doubt; and whether there was nothing wrong with it.

    `suspect`: called where the first one leaves the timer standing still. `second`: gets the call that comes next,
    where all is well when the first is answered: what the timer does after that is seen meanwhile.
    """
    calls: list[Call] = []
    series: Sequence[Series] = ()
    while not calls or (run.exit is None and needs_repeat(run.logs, calls, series, MOST_TRIES)):
        await asyncio.gather(*second)  # it would be in the way
        answer, lost_s = await _make_call(run, _operands(), limit_s)
        if not calls and _is_wrong(answer):
            bench.report_facts(SingleCalls(run.trace(), (Call(answer, run.now(), lost_s),)))
        series = (await bench.facts(run_idle)).series
        if not calls and run.exit is None and _is_well(run, Call(answer, run.now(), lost_s), series):
            second.append(asyncio.ensure_future(_make_call(run, _large(), ANSWER_S)))
        await next_tick(run, series, answer)
        calls.append(Call(answer, run.now(), lost_s))
        if len(calls) == 1 and run.exit is None and is_disturbed(run.logs, calls[0], series):
            suspect(answer.response is not None)
    last = calls[-1]
    well = not is_disturbed(run.logs, last, series) or is_excused(run.logs, last, series)
    return calls, last.answer.response is not None and well


async def _call_again(run: Run, series: Sequence[Series], begun: asyncio.Task[_Made] | None = None) -> list[Call]:
    """Make a call with large numbers, or take the one that is `begun`; again where a busy machine leaves it in doubt.

    No more often than the first: without a word of the timer it takes nothing back.
    """
    calls: list[Call] = []
    while not calls or (run.exit is None and needs_repeat(run.logs, calls, series, TRIES)):
        answer, lost_s = await (begun if begun and not calls else _make_call(run, _large(), ANSWER_S))
        call = Call(answer, run.now(), lost_s)
        if is_disturbed(run.logs, call, series):  # or is it only that its next message is still to come?
            await next_tick(run, series, answer)
            call = replace(call, until=run.now())
        calls.append(call)
    return calls


def _is_well(run: Run, call: Call, series: Sequence[Series]) -> bool:
    """Whether the call was answered right and in time, and nothing has disturbed the timer until then."""
    return call.in_time and not _is_wrong(call.answer) and not is_disturbed(run.logs, call, series)


def _is_wrong(answer: CallAnswer) -> bool:
    """Whether it has an answer that no repetition makes right: another sum, or one that comes too soon."""
    return answer.response is not None and (answer.response["sum"] != right_sum(answer) or answer.took_s < SHORTEST_S)


async def _is_served(run: Run) -> bool:
    """Wait for the service, and give whether it is there."""
    return await wait_until_seen(run, lambda: has_service(run.graph.servers))


def _answer_limit_s(spins: bool) -> float:
    """How long a call may take: a node that answers nothing yet has begun to spin, and done the work, by then."""
    return ANSWER_S if spins else SPINS_S + LONGEST_S + EXCUSED_S


async def _spins(run: Run) -> bool:
    """Wait until the node answers what every node does; False where it could, and does not.

    It may be in the graph long before it spins.
    """
    if await run.until(lambda: bool(run.graph.parameter_nodes), IN_GRAPH_S):
        return await run.parameters(SPINS_S) is not None
    return True


def _lost_s(run: Run) -> float:
    return run.node_cpu_wait_s() + run.our_cpu_wait_s()


async def _stuck(bench: Bench, *, answers: bool) -> tuple[tuple[Frame, ...], bool]:
    """Call once more, only to see where the node is while it works on the call, and whether it spins at all."""
    async with bench.start(FILE) as run:
        bench.report_progress(0.9, "looking where the node is during a call")
        await _is_served(run)
        spins = await run.parameters(2.0) is not None
        # A callback that answers is in the middle of its work; one that does not may come to a halt after it.
        into_s = WORK_S / 2 if answers else WORK_S + 0.5
        await run.call(SERVICE, TYPE, _operands(), limit_s=into_s)
        return await run.dump_stacks(), spins


async def call_concurrently(bench: Bench) -> ConcurrentCalls:
    """Three calls at once, each with its own sum."""
    async with bench.start(FILE, expected_s=3.5) as run:
        bench.report_progress(0.1, f"waiting for {SERVICE}")
        if not await _is_served(run):
            return ConcurrentCalls(run.trace())
        limit_s = _answer_limit_s(await _spins(run))
        bench.report_progress(0.3, f"calling {SERVICE} three times at once")
        made: list[CallBatch] = []
        while not made or needs_repeat_at_once(ConcurrentCalls(run.trace(), tuple(made))):
            lost_s = _lost_s(run)
            made.append(CallBatch(await _ask_at_once(run, _different(), limit_s), _lost_s(run) - lost_s))
        return ConcurrentCalls(run.trace(), tuple(made))


async def _ask_at_once(run: Run, requests: Sequence[Mapping[str, int]], limit_s: float) -> tuple[CallAnswer, ...]:
    """Make all calls at once; give up when none has been answered for `limit_s`, as long as one call may take."""
    calls: list[asyncio.Task[CallAnswer]] = []
    asked_at = run.now()
    for request in requests:
        if len(calls) == len(requests) - 1:
            await run.until(lambda: run.now() >= asked_at + APART_S, 1.0)
        calls.append(asyncio.create_task(run.call(SERVICE, TYPE, request, limit_s=len(requests) * limit_s)))
    while (answered := _done(calls)) < len(calls):
        if not await run.until(lambda answered=answered: _done(calls) > answered, limit_s):  # type: ignore[misc]
            break
    for call in calls:
        call.cancel()
    await asyncio.gather(*calls, return_exceptions=True)
    return tuple(
        CallAnswer(SERVICE, request, None, asked_at, run.now()) if call.cancelled() else call.result()
        for request, call in zip(requests, calls, strict=True)
    )


def _done(calls: Sequence[asyncio.Task[CallAnswer]]) -> int:
    return sum(call.done() for call in calls)


@repeat_if_doubtful
async def interrupt_during_call(bench: Bench) -> Interrupted:
    """Press Ctrl+C during a call."""
    async with bench.start(FILE, expected_s=2.0) as run:
        bench.report_progress(0.1, f"waiting for {SERVICE}")
        called = await _is_served(run)
        if called:
            await _spins(run)
        call = asyncio.create_task(run.call(SERVICE, TYPE, _operands(), limit_s=ANSWER_S))
        try:
            if called:
                bench.report_progress(0.4, f"calling {SERVICE}")
                due, cpu_wait_s = run.now() + INTO_CALL_S, run.node_cpu_wait_s()
                await run.until(
                    lambda: call.done() or run.now() >= due + run.node_cpu_wait_s() - cpu_wait_s, 2 * INTO_CALL_S
                )
            trace = run.trace()
            bench.report_progress(0.7, "pressing Ctrl+C during the call")
            ended = await run.interrupt() if run.exit is None else None
        finally:
            call.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await call
        return Interrupted(trace, called, ended)


def _operands() -> Mapping[str, int]:
    """Operands by chance, so that no sum can be known beforehand."""
    return {"a": random.randint(-900, 900), "b": random.randint(1000, 9000)}


def _large() -> Mapping[str, int]:
    """Operands whose sum needs an integer of 64 bits: neither 32 bits nor a float can hold it."""
    return {"a": 2**53 + 2 * random.randint(1, 2**50) + 1, "b": 2 * random.randint(1, 900)}


def _different() -> list[Mapping[str, int]]:
    """Operands for calls at once, whose sums all differ."""
    start = random.randint(-900, 900)
    return [{"a": start + 1000 * number, "b": random.randint(1, 900)} for number in range(CALLS)]
