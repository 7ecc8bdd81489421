"""I2.3: scenarios that run the node and gather facts."""

from __future__ import annotations

import asyncio
import contextlib
import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from checks.i2_3.facts import (
    ANSWER_TIMEOUT_S,
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
from checks.i2_3.repeats import MAX_TRIES, TRIES, needs_repeat, needs_repeat_at_once
from checks.i2_3.ticks import Series, all_series, timer_series
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import repeat_if_doubtful
from tutor.judge.trace import CallAnswer
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting import CPU_WAIT_SHARE, IDLE_S, patience_s, wait_until_seen

INTO_CALL_S = 1.5
"""A call is being processed this long after the request."""

CALL_LOGS_S = 0.3
"""What is logged this soon after a request may be the service callback's own message, not the timer's."""

SILENT_S = 1.5
"""A node that logs nothing for this long during a call may be blocked by it: most timers log once a second."""

DISCOVERY_S = 1.0
"""Time limit for all services of a node to appear in the graph once the node is discovered."""

SPIN_S = 2.5
"""A node spins within twice this time of its service being discovered, or never."""

APART_S = 0.1
"""Delay of the last of three concurrent calls, so that the order of the answers has a meaning."""


@repeat_if_doubtful
async def run_idle(bench: Bench) -> IdleRun:
    """Listen to the idle node, then press Ctrl+C."""
    async with bench.start(FILE) as run:  # start first, like `call_singly`, which waits for these facts
        bench.report_progress(0.1, "waiting for the timer's log messages")
        await wait_until_seen(run, lambda: bool(run.graph.nodes))
        up_at = run.now()
        # A timer needs a node that spins.
        may_tick = await _wait_until_spinning(run) or bool(logs_since(run.logs, up_at))
        since, waited_before_s = run.now(), _cpu_wait_s(run)
        if may_tick:
            await wait_until_seen(run, lambda: bool(logs_since(run.logs, since)), idle_s=IDLE_S)
        listened_at, cpu_wait_s = run.now(), run.node_cpu_wait_s()
        bench.report_progress(0.3, "listening to the timer")
        if may_tick:
            await listen(run, since, waited_before_s, lambda: has_service(run.graph.servers))
        share = (run.node_cpu_wait_s() - cpu_wait_s) / max(0.1, run.now() - listened_at)
        series = timer_series(all_series(logs_since(run.logs, since)))
        busy = share >= CPU_WAIT_SHARE and any(may_be_10_hz(each, share) for each in series if not each.is_10_hz)
        idle = IdleRun(run.trace(), series, busy)
        bench.report_progress(0.8, "pressing Ctrl+C")
        return replace(idle, ending=await run.interrupt() if run.exit is None else None)


async def call_singly(bench: Bench) -> SingleCalls:
    """Call the service, then once more, and watch the timer during the calls and until its next message."""
    dumps: dict[bool, asyncio.Task[tuple[tuple[Frame, ...], bool]]] = {}

    def suspect(answers: bool) -> None:
        if answers not in dumps:
            dumps[answers] = asyncio.ensure_future(_dump_stacks(bench, answers=answers))

    try:
        seen, fine = await _call_singly(bench, suspect)
        if seen.calls and seen.trace.exit is None and not fine:
            suspect(answers := seen.calls[-1].answer.response is not None)
            stuck, spins = await dumps[answers]
            return replace(seen, stuck=stuck, spins=spins)
        return seen
    finally:
        for task in dumps.values():
            task.cancel()
        await asyncio.gather(*dumps.values(), return_exceptions=True)


async def _call_singly(bench: Bench, suspect: Callable[[bool], None]) -> tuple[SingleCalls, bool]:
    """Make the calls; also return whether the first one was fine.

    `suspect` is called as soon as it may not be, with whether the node answers at all.
    """
    async with bench.start(FILE) as run:
        bench.report_progress(0.1, f"waiting for {SERVICE}")
        if not await _wait_for_service(run):
            return SingleCalls(run.trace()), False
        if not (spins := await _wait_until_spinning(run)):
            suspect(False)
        bench.report_progress(0.2, f"calling {SERVICE}")
        second: list[asyncio.Task[_TimedAnswer]] = []
        try:
            calls, fine = await _call_first(bench, run, suspect, second, _answer_limit_s(spins))
            later: Sequence[Call] = ()
            idle = await bench.facts(run_idle)
            bench.report_facts(SingleCalls(run.trace(), tuple(calls), idle=idle))
            if fine and run.exit is None:
                bench.report_progress(0.6, f"calling {SERVICE} once more")
                later = await _call_second(run, idle.series, *second)
        finally:
            for task in second:
                task.cancel()
            await asyncio.gather(*second, return_exceptions=True)
        return SingleCalls(run.trace(), tuple(calls), later=tuple(later)), fine


_TimedAnswer = tuple[CallAnswer, float]
"""The answer to a call, and how long (in seconds) the node and our process waited for the CPU during it."""


async def _make_call(run: Run, operands: Mapping[str, int], limit_s: float) -> _TimedAnswer:
    waited_s = _cpu_wait_s(run)
    answer = await run.call(SERVICE, TYPE, operands, limit_s=limit_s)
    return answer, _cpu_wait_s(run) - waited_s


async def _make_first_call(run: Run, suspect: Callable[[bool], None], limit_s: float) -> _TimedAnswer:
    """Make a call; `suspect` is called if the node goes silent, or does not answer while a correct one would have."""
    call, asked_at = asyncio.ensure_future(_make_call(run, _large_operands(), limit_s)), run.now()

    def is_silent() -> bool:
        last_at = run.logs[-1].stamp if run.logs else asked_at
        return run.now() >= (last_at if last_at >= asked_at + CALL_LOGS_S else asked_at) + SILENT_S

    try:
        await run.until(lambda: call.done() or is_silent(), LONGEST_S)
        if not call.done() and run.exit is None:
            suspect(True)
        done, _ = await asyncio.wait({call}, timeout=max(0.0, asked_at + LONGEST_S + 2 * EXCUSED_S - run.now()))
        if not done:
            suspect(False)
        return await call
    finally:
        call.cancel()


async def _call_first(
    bench: Bench,
    run: Run,
    suspect: Callable[[bool], None],
    second: list[asyncio.Task[_TimedAnswer]],
    limit_s: float,
) -> tuple[list[Call], bool]:
    """Make the first call, and repeat it while a busy machine leaves it in doubt; also return whether it was fine.

    `suspect`: called if the timer stops during the first call. `second`: receives the task of the second call, which is
    started right after the first answer if all is well so far, to save time: the timer is still being watched then.
    """
    calls: list[Call] = []
    series: Sequence[Series] = ()
    while not calls or (run.exit is None and needs_repeat(run.logs, calls, series, MAX_TRIES)):
        await asyncio.gather(*second)  # must not overlap with a repetition
        answer, waited_s = await (
            _make_call(run, _large_operands(), limit_s) if calls else _make_first_call(run, suspect, limit_s)
        )
        if not calls and _is_wrong(answer):
            bench.report_facts(SingleCalls(run.trace(), (Call(answer, run.now(), waited_s),)))
        series = (await bench.facts(run_idle)).series
        if not calls and run.exit is None and _is_fine(run, Call(answer, run.now(), waited_s), series):
            second.append(asyncio.ensure_future(_make_call(run, _random_operands(), ANSWER_TIMEOUT_S)))
        await next_tick(run, series, answer)
        calls.append(Call(answer, run.now(), waited_s))
        if len(calls) == 1 and run.exit is None and is_disturbed(run.logs, calls[0], series):
            suspect(answer.response is not None)
    last = calls[-1]
    fine = not is_disturbed(run.logs, last, series) or is_excused(run.logs, last, series)
    return calls, last.answer.response is not None and fine


async def _call_second(
    run: Run, series: Sequence[Series], started: asyncio.Task[_TimedAnswer] | None = None
) -> list[Call]:
    """Make a second call, or await the `started` one; repeat it while a busy machine leaves it in doubt.

    At most `TRIES` times, since an inconclusive second call does not change the verdict on the first.
    """
    calls: list[Call] = []
    while not calls or (run.exit is None and needs_repeat(run.logs, calls, series, TRIES)):
        answer, waited_s = await (
            started if started and not calls else _make_call(run, _random_operands(), ANSWER_TIMEOUT_S)
        )
        call = Call(answer, run.now(), waited_s)
        if is_disturbed(run.logs, call, series):  # perhaps only because its next message has not come yet
            await next_tick(run, series, answer)
            call = replace(call, until=run.now())
        calls.append(call)
    return calls


def _is_fine(run: Run, call: Call, series: Sequence[Series]) -> bool:
    """Whether the call was answered correctly and in time, and the timer has been undisturbed until now."""
    return call.in_time and not _is_wrong(call.answer) and not is_disturbed(run.logs, call, series)


def _is_wrong(answer: CallAnswer) -> bool:
    """Whether the answer is wrong however busy the machine is: a wrong sum, or one that comes too early."""
    return answer.response is not None and (answer.response["sum"] != right_sum(answer) or answer.took_s < SHORTEST_S)


async def _wait_for_service(run: Run) -> bool:
    """Wait for the service, and return whether it exists."""
    return await wait_until_seen(
        run,
        lambda: has_service(run.graph.servers),
        settle_s=lambda: patience_s(((each.name, each.type) for each in run.graph.servers), SERVICE, TYPE),
    )


def _answer_limit_s(spins: bool) -> float:
    """Timeout of a call. A node that does not spin yet has time to begin to, and to do the work."""
    return ANSWER_TIMEOUT_S if spins else SPIN_S + LONGEST_S + EXCUSED_S


async def _wait_until_spinning(run: Run) -> bool:
    """Wait until the node answers a parameter request; False if it has parameter services, but does not answer.

    A node may be in the graph long before it spins.
    """
    if await run.until(lambda: bool(run.graph.parameter_nodes), DISCOVERY_S):
        return await run.parameters(SPIN_S) is not None
    return True


def _cpu_wait_s(run: Run) -> float:
    return run.node_cpu_wait_s() + run.our_cpu_wait_s()


async def _dump_stacks(bench: Bench, *, answers: bool) -> tuple[tuple[Frame, ...], bool]:
    """Start the node again and call it, only to take a stack dump during the call, and to see whether it spins."""
    async with bench.start(FILE) as run:
        bench.report_progress(0.9, "finding out where the node is during a call")
        await _wait_for_service(run)
        spins = await run.parameters(2.0) is not None
        # A callback that answers is looked at halfway; one that does not may hang only after its work.
        dump_after_s = WORK_S / 2 if answers else WORK_S + 0.5
        await run.call(SERVICE, TYPE, _random_operands(), limit_s=dump_after_s)
        return await run.dump_stacks(), spins


async def call_concurrently(bench: Bench) -> ConcurrentCalls:
    """Make three concurrent calls, each with its own sum."""
    async with bench.start(FILE, expected_s=3.5) as run:
        bench.report_progress(0.1, f"waiting for {SERVICE}")
        if not await _wait_for_service(run):
            return ConcurrentCalls(run.trace())
        limit_s = _answer_limit_s(await _wait_until_spinning(run))
        bench.report_progress(0.3, f"calling {SERVICE} three times at once")
        batches: list[CallBatch] = []
        while not batches or needs_repeat_at_once(ConcurrentCalls(run.trace(), tuple(batches))):
            waited_s = _cpu_wait_s(run)
            batches.append(
                CallBatch(await _call_at_once(run, _distinct_operands(), limit_s), _cpu_wait_s(run) - waited_s)
            )
        return ConcurrentCalls(run.trace(), tuple(batches))


async def _call_at_once(run: Run, requests: Sequence[Mapping[str, int]], limit_s: float) -> tuple[CallAnswer, ...]:
    """Make all calls at once; give up if no answer has come for `limit_s`, the timeout of a single call."""
    calls: list[asyncio.Task[CallAnswer]] = []
    asked_at = run.now()
    for request in requests:
        if len(calls) == len(requests) - 1:
            await run.until(lambda: run.now() >= asked_at + APART_S, 1.0)
        calls.append(asyncio.create_task(run.call(SERVICE, TYPE, request, limit_s=len(requests) * limit_s)))
    while (answered := _count_done(calls)) < len(calls):
        if not await run.until(lambda answered=answered: _count_done(calls) > answered, limit_s):  # type: ignore[misc]
            break
    for call in calls:
        call.cancel()
    await asyncio.gather(*calls, return_exceptions=True)
    return tuple(
        CallAnswer(SERVICE, request, None, asked_at, run.now()) if call.cancelled() else call.result()
        for request, call in zip(requests, calls, strict=True)
    )


def _count_done(calls: Sequence[asyncio.Task[CallAnswer]]) -> int:
    return sum(call.done() for call in calls)


@repeat_if_doubtful
async def interrupt_during_call(bench: Bench) -> Interrupted:
    """Press Ctrl+C during a call."""
    async with bench.start(FILE, expected_s=2.0) as run:
        bench.report_progress(0.1, f"waiting for {SERVICE}")
        called = await _wait_for_service(run)
        if called:
            await _wait_until_spinning(run)
        call = asyncio.create_task(run.call(SERVICE, TYPE, _random_operands(), limit_s=ANSWER_TIMEOUT_S))
        try:
            if called:
                bench.report_progress(0.4, f"calling {SERVICE}")
                due, cpu_wait_s = run.now() + INTO_CALL_S, run.node_cpu_wait_s()
                await run.until(
                    lambda: call.done() or run.now() >= due + run.node_cpu_wait_s() - cpu_wait_s, 2 * INTO_CALL_S
                )
            trace = run.trace()
            bench.report_progress(0.7, "pressing Ctrl+C during the call")
            ending = await run.interrupt() if run.exit is None else None
        finally:
            call.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await call
        return Interrupted(trace, called, ending)


def _random_operands() -> Mapping[str, int]:
    """Random operands, so that the sum cannot be known in advance."""
    return {"a": random.randint(-900, 900), "b": random.randint(1000, 9000)}


def _large_operands() -> Mapping[str, int]:
    """Operands whose sum needs a 64-bit integer: neither 32 bits nor a float can represent it.

    Their product fits into one, too, so that a node that multiplies answers all the same.
    """
    return {"a": 2**53 + 2 * random.randint(1, 2**50) + 1, "b": 2 * random.randint(1, 400)}


def _distinct_operands() -> list[Mapping[str, int]]:
    """Operands for concurrent calls, whose sums all differ."""
    start = random.randint(-900, 900)
    return [{"a": start + 1000 * number, "b": random.randint(1, 900)} for number in range(CALLS)]
