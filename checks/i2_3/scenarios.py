"""I2.3: scenarios that run the node and gather facts."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Mapping, Sequence
from dataclasses import replace

from checks.i2_3.calling import (
    distinct_operands,
    random_operands,
    total_cpu_wait_s,
    wait_for_service,
    wait_until_spinning,
)
from checks.i2_3.facts import (
    ANSWER_TIMEOUT_S,
    FILE,
    SERVICE,
    TYPE,
    CallBatch,
    ConcurrentCalls,
    IdleRun,
    Interrupted,
    has_service,
)
from checks.i2_3.listening import listen, logs_since, may_be_10_hz
from checks.i2_3.repeats import needs_repeat_at_once
from checks.i2_3.ticks import all_series, timer_series
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import repeat_if_doubtful
from tutor.judge.trace import CallAnswer
from tutor.judge.waiting import CPU_WAIT_SHARE, IDLE_S, wait_until_seen

INTO_CALL_S = 1.5
"""A call is being processed this long after the request."""

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
        may_tick = (await wait_until_spinning(bench, run)).spins or bool(logs_since(run.logs, up_at))
        since, waited_before_s = run.now(), total_cpu_wait_s(run)
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
        return replace(idle, ending=await run.interrupt())


async def call_concurrently(bench: Bench) -> ConcurrentCalls:
    """Make three concurrent calls, each with its own sum."""
    async with bench.start(FILE, expected_s=3.5) as run:
        bench.report_progress(0.1, f"waiting for {SERVICE}")
        if not await wait_for_service(run):
            return ConcurrentCalls(run.trace())
        limit_s = (await wait_until_spinning(bench, run)).limit_s
        bench.report_progress(0.3, f"calling {SERVICE} three times at once")
        batches: list[CallBatch] = []
        while not batches or needs_repeat_at_once(ConcurrentCalls(run.trace(), tuple(batches))):
            waited_s = total_cpu_wait_s(run)
            batches.append(
                CallBatch(await _call_at_once(run, distinct_operands(), limit_s), total_cpu_wait_s(run) - waited_s)
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
        called = await wait_for_service(run)
        if called:
            await wait_until_spinning(bench, run)
        call = asyncio.create_task(run.call(SERVICE, TYPE, random_operands(), limit_s=ANSWER_TIMEOUT_S))
        due = run.now() + INTO_CALL_S
        try:
            if called:
                bench.report_progress(0.4, f"calling {SERVICE}")
                cpu_wait_s = run.node_cpu_wait_s()
                await run.until(
                    lambda: call.done() or run.now() >= due + run.node_cpu_wait_s() - cpu_wait_s, 2 * INTO_CALL_S
                )
            trace = run.trace()
            bench.report_progress(0.7, "pressing Ctrl+C during the call")
            ending = await run.interrupt()
        finally:
            call.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await call
        slowed = ending is None and run.exit is not None and run.started_at + run.exit.after_s >= due
        return Interrupted(trace, called, ending, slowed)
