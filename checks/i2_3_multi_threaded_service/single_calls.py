"""I2.3: the scenario that calls the service, then once more, while the timer is watched."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

from checks.i2_3_multi_threaded_service.call_scenarios import (
    dump_silent_node,
    large_operands,
    make_call,
    wait_for_service,
    wait_until_spinning,
)
from checks.i2_3_multi_threaded_service.calls import (
    ALLOWANCE_S,
    LONGEST_S,
    PROGRAM,
    SLOW_ADD,
    WORK_S,
    Call,
    is_wrong,
)
from checks.i2_3_multi_threaded_service.idle_run import IdleRun, listen_until_tick, run_idle
from checks.i2_3_multi_threaded_service.timer_pace import MAX_TRIES, TRIES, Watch
from tutor.judge.bench import Bench, Run
from tutor.judge.tasks import Tasks
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame

CALL_LOGS_S = 0.3
"""What is logged this soon after a request may be the service callback's own message, not the timer's."""

SILENT_S = 1.5
"""A node that logs nothing for this long during a call may be blocked by it: most timers log once a second."""


@dataclass(frozen=True)
class SingleCalls:
    """Single calls with large numbers: one, or more if the first was disturbed; none if there was no service.

    `later`: the second call and its repetitions; only made if nothing was wrong with the first.
    `stuck`: the stack dump of the node's threads during a call (innermost frames first), taken if the call was not
    answered or the timer paused; `spins`: whether the node answered any request then. `idle`: the run without calls,
    if the first call is reported before the scenario has ended.
    """

    trace: Trace
    calls: tuple[Call, ...] = ()
    stuck: tuple[Frame, ...] = ()
    spins: bool = True
    later: tuple[Call, ...] = ()
    idle: IdleRun | None = None

    @property
    def first_and_later(self) -> tuple[SingleCalls, ...]:
        """The first call and the second one, each with its repetitions, to be judged separately."""
        first = replace(self, later=())
        return (first, replace(first, calls=self.later)) if self.later else (first,)

    @property
    def quickest(self) -> Call | None:
        """The answered call that took the least time, and so was delayed least by the machine."""
        return min((call for call in self.calls if call.answered), key=lambda call: call.answer.took_s, default=None)


Dump = Callable[[bool], asyncio.Task[tuple[tuple[Frame, ...], bool]]]
"""Starts a dump of the node's stacks, unless it has been started; takes whether the node answers at all."""


async def call_singly(bench: Bench) -> SingleCalls:
    """Call the service, then once more, and watch the timer during the calls and until its next message."""
    async with Tasks() as dumps:

        @cache
        def dump(answers: bool) -> asyncio.Task[tuple[tuple[Frame, ...], bool]]:
            return dumps.start(_dump_stacks(bench, answers))

        seen, is_clear = await _call_twice(bench, dump)
        if is_clear or not seen.calls or seen.trace.exit is not None:
            return seen
        stuck, spins = await dump(seen.calls[-1].answered)
        return replace(seen, stuck=stuck, spins=spins)


async def _call_twice(bench: Bench, dump: Dump) -> tuple[SingleCalls, bool]:
    """Make both calls; also return whether the first one was fine, or it is known why not.

    `dump` is called as soon as it may not be. A call is repeated while the machine may be to blame for what it showed.
    """
    async with bench.start(PROGRAM.file) as run, Tasks() as tasks:
        bench.report_progress(0.1, f"waiting for {SLOW_ADD.name}")
        if not await wait_for_service(run):
            return SingleCalls(run.trace()), False
        ready = await wait_until_spinning(bench, run)
        if ready.is_stuck:
            call = await make_call(run, ready.limit_s)
            return SingleCalls(run.trace(), (call,), await bench.facts(dump_silent_node), spins=False), True
        if not ready.spins:
            dump(False)
        bench.report_progress(0.2, f"calling {SLOW_ADD.name}")
        first = await _make_first_call(run, tasks, dump, ready.limit_s)
        if is_wrong(first.answer):
            bench.report_facts(SingleCalls(run.trace(), (first,)))
        idle = await bench.facts(run_idle)

        def watch() -> Watch:
            return Watch(run.logs, idle.series)

        def needs_another(made: list[Call], most: int) -> bool:
            return run.exit is None and watch().needs_repeat(made, most)

        second: asyncio.Task[Call] | None = None
        good = first.in_time and not is_wrong(first.answer)
        if good and run.exit is None and not watch().is_disturbed(replace(first, until=run.now())):
            second = tasks.start(make_call(run))  # to save time: the timer is still being watched
        calls = [await listen_until_tick(run, idle.series, first)]
        if run.exit is None and watch().is_disturbed(calls[0]):
            dump(calls[0].answered)
        while needs_another(calls, MAX_TRIES):
            if second is not None:
                await second  # must not overlap with a repetition
            again = await make_call(run, ready.limit_s, large_operands())
            calls.append(await listen_until_tick(run, idle.series, again))
        last = calls[-1]
        is_clear = last.answered and (not watch().is_disturbed(last) or watch().is_slowed(last))
        bench.report_facts(SingleCalls(run.trace(), tuple(calls), idle=idle))
        later: list[Call] = []
        if is_clear and run.exit is None:
            bench.report_progress(0.6, f"calling {SLOW_ADD.name} once more")
            second = second or tasks.start(make_call(run))
            later.append(await _listen_if_disturbed(run, watch, await second))
            # A second call that is slowed every time does not change the verdict on the first.
            while needs_another(later, TRIES):
                later.append(await _listen_if_disturbed(run, watch, await make_call(run)))
        return SingleCalls(run.trace(), tuple(calls), later=tuple(later)), is_clear


async def _make_first_call(run: Run, tasks: Tasks, dump: Dump, limit_s: float) -> Call:
    """Make a call; the stacks are dumped if the node goes silent, or does not answer while a correct one would have."""
    call, asked_at = tasks.start(make_call(run, limit_s, large_operands())), run.now()

    def is_silent() -> bool:
        last_at = run.logs[-1].stamp if run.logs else asked_at
        return run.now() >= (last_at if last_at >= asked_at + CALL_LOGS_S else asked_at) + SILENT_S

    await run.until(lambda: call.done() or is_silent(), LONGEST_S)
    if not call.done() and run.exit is None:
        dump(True)
    done, _ = await asyncio.wait({call}, timeout=max(0.0, asked_at + LONGEST_S + 2 * ALLOWANCE_S - run.now()))
    if not done:
        dump(False)
    return await call


async def _listen_if_disturbed(run: Run, watch: Callable[[], Watch], call: Call) -> Call:
    """Listen on if the timer seems disturbed: perhaps only because its next message has not come yet."""
    until_now = replace(call, until=run.now())
    return await listen_until_tick(run, watch().series, call) if watch().is_disturbed(until_now) else until_now


async def _dump_stacks(bench: Bench, answers: bool) -> tuple[tuple[Frame, ...], bool]:
    """Start the node again and call it, only to take a stack dump during the call, and to see whether it spins."""
    async with bench.start(PROGRAM.file) as run:
        bench.report_progress(0.9, "finding out where the node is during a call")
        await wait_for_service(run)
        spins = await run.parameters(2.0) is not None
        # A callback that answers is looked at halfway; one that does not may hang only after its work.
        await make_call(run, WORK_S / 2 if answers else WORK_S + 0.5)
        return await run.dump_stacks(), spins
