"""I2.3: the scenario that calls the service, then once more, while the timer is watched."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from checks.i2_3.calling import (
    dump_silent_node,
    large_operands,
    random_operands,
    total_cpu_wait_s,
    wait_for_service,
    wait_until_spinning,
)
from checks.i2_3.facts import (
    ANSWER_TIMEOUT_S,
    EXCUSED_S,
    FILE,
    LONGEST_S,
    SERVICE,
    SHORTEST_S,
    TYPE,
    WORK_S,
    Call,
    SingleCalls,
    is_disturbed,
    is_excused,
    right_sum,
)
from checks.i2_3.listening import next_tick
from checks.i2_3.repeats import MAX_TRIES, TRIES, needs_repeat
from checks.i2_3.scenarios import run_idle
from checks.i2_3.ticks import Series
from tutor.judge.bench import Bench, Run
from tutor.judge.trace import CallAnswer
from tutor.judge.tracebacks import Frame

CALL_LOGS_S = 0.3
"""What is logged this soon after a request may be the service callback's own message, not the timer's."""

SILENT_S = 1.5
"""A node that logs nothing for this long during a call may be blocked by it: most timers log once a second."""


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
    """Make the calls; also return whether the first one was fine, or it is known why not.

    `suspect` is called as soon as it may not be, with whether the node answers at all.
    """
    async with bench.start(FILE) as run:
        bench.report_progress(0.1, f"waiting for {SERVICE}")
        if not await wait_for_service(run):
            return SingleCalls(run.trace()), False
        ready = await wait_until_spinning(bench, run)
        if ready.is_stuck:
            answer, waited_s = await _make_call(run, random_operands(), ready.limit_s)
            call = Call(answer, run.now(), waited_s)
            return SingleCalls(run.trace(), (call,), await bench.facts(dump_silent_node), spins=False), True
        if not ready.spins:
            suspect(False)
        bench.report_progress(0.2, f"calling {SERVICE}")
        second: list[asyncio.Task[_TimedAnswer]] = []
        try:
            calls, fine = await _call_first(bench, run, suspect, second, ready.limit_s)
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
    waited_s = total_cpu_wait_s(run)
    answer = await run.call(SERVICE, TYPE, operands, limit_s=limit_s)
    return answer, total_cpu_wait_s(run) - waited_s


async def _make_first_call(run: Run, suspect: Callable[[bool], None], limit_s: float) -> _TimedAnswer:
    """Make a call; `suspect` is called if the node goes silent, or does not answer while a correct one would have."""
    call, asked_at = asyncio.ensure_future(_make_call(run, large_operands(), limit_s)), run.now()

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
            _make_call(run, large_operands(), limit_s) if calls else _make_first_call(run, suspect, limit_s)
        )
        if not calls and _is_wrong(answer):
            bench.report_facts(SingleCalls(run.trace(), (Call(answer, run.now(), waited_s),)))
        series = (await bench.facts(run_idle)).series
        if not calls and run.exit is None and _is_fine(run, Call(answer, run.now(), waited_s), series):
            second.append(asyncio.ensure_future(_make_call(run, random_operands(), ANSWER_TIMEOUT_S)))
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
            started if started and not calls else _make_call(run, random_operands(), ANSWER_TIMEOUT_S)
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


async def _dump_stacks(bench: Bench, *, answers: bool) -> tuple[tuple[Frame, ...], bool]:
    """Start the node again and call it, only to take a stack dump during the call, and to see whether it spins."""
    async with bench.start(FILE) as run:
        bench.report_progress(0.9, "finding out where the node is during a call")
        await wait_for_service(run)
        spins = await run.parameters(2.0) is not None
        # A callback that answers is looked at halfway; one that does not may hang only after its work.
        dump_after_s = WORK_S / 2 if answers else WORK_S + 0.5
        await run.call(SERVICE, TYPE, random_operands(), limit_s=dump_after_s)
        return await run.dump_stacks(), spins
