"""I2.3: what is done to the node."""

from __future__ import annotations

import asyncio
import contextlib
import random
from collections.abc import Mapping, Sequence
from itertools import takewhile

from checks.i2_3.facts import (
    ANSWER_S,
    CALLS,
    FILE,
    LONGEST_S,
    SERVICE,
    TYPE,
    WORK_S,
    Interrupted,
    Lone,
    Quiet,
    Trio,
    is_there,
)
from checks.i2_3.ticks import HZ, Series, all_series, during, likely
from tutor.judge.bench import Bench, Run
from tutor.judge.rates import TOLERANCE
from tutor.judge.trace import CallAnswer, LogRecord
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting import IN_FLIGHT_S, STARVED, TRIES, appears

UP_S = 1.5
"""What a node logs later than this after its first sign of life is no greeting."""

LISTEN_S = 6.5
"""Time enough to see that what comes is of another pace, or that nothing comes, not even from a tick in fifty."""

RARE_S = 12.0
"""Time enough for a second message of a timer that logs every fiftieth tick."""

LOOK_EVERY_S = 0.1

INTO_CALL_S = 1.5
"""A call that was made this long ago is being worked on."""


async def quiet(bench: Bench) -> Quiet:
    """Listen to the node while nobody calls, then press Ctrl+C."""
    async with bench.start(FILE) as run:
        bench.doing(0.1, "waiting for the timer's log messages")
        await appears(run, lambda: bool(run.logs))
        up_at, starved_s = run.now(), run.starved_s()
        bench.doing(0.3, "listening to the timer")
        await _listen(run, up_at)
        share = (run.starved_s() - starved_s) / max(0.1, run.now() - up_at)
        series = likely(all_series(run.logs))
        trace = run.trace()
        bench.doing(0.8, "pressing Ctrl+C")
        ended = await run.interrupt() if run.exit is None else None
    excused = share >= STARVED and any(_may_be_10_hz(each, share) for each in series if not each.is_10_hz)
    return Quiet(trace, series, excused, ended)


async def _listen(run: Run, up_at: float) -> None:
    """Wait until the logs tell what there is to know about the timer."""
    looked_at, enough = 0.0, False

    def heard() -> bool:
        nonlocal looked_at, enough
        if run.now() - looked_at >= LOOK_EVERY_S:  # not at each of a thousand messages
            looked_at = run.now()
            enough = _told(run.logs) or run.now() - up_at > _patience_s(run.logs)
        return enough

    await run.until(heard, 2 * RARE_S)


def _told(logs: Sequence[LogRecord]) -> bool:
    """Whether a timer of 10 Hz has been seen for long enough to know its pace."""
    return any(
        series.is_10_hz and (series.span_s >= 3.5 or (series.span_s >= 1.8 and len(series.ticks) > 2))
        for series in all_series(logs)
    )


def _patience_s(logs: Sequence[LogRecord]) -> float:
    """How long to listen. A late message that nothing explains may be the first of a timer that logs rarely."""
    often = [series for series in all_series(logs) if len(series.ticks) > 2]
    late = [log for log in logs if log.stamp - logs[0].stamp > UP_S]
    if any(not any(series.key.of(log) for series in often) for log in late):
        return RARE_S
    return LISTEN_S


def _may_be_10_hz(series: Series, share: float) -> bool:
    return series.hz < HZ and series.hz / max(0.05, 1 - share) >= (1 - TOLERANCE) * HZ


async def lone(bench: Bench) -> Lone:
    """Call the service once, and listen to the timer meanwhile and until it is heard again."""
    async with bench.start(FILE) as run:
        bench.doing(0.1, f"waiting for {SERVICE}")
        if not await appears(run, lambda: is_there(run.graph.services)):
            return Lone(run.trace())
        for tried in range(1, TRIES + 1):
            bench.doing(0.3, f"calling {SERVICE}")
            starved_s = run.starved_s()
            answer = await run.call(SERVICE, TYPE, _operands(), limit_s=ANSWER_S)
            starved_s = run.starved_s() - starved_s
            series = (await bench.facts(quiet)).series
            bench.doing(0.8, "listening to the timer after the call")
            await _next_tick(run, series, answer)
            seen = Lone(run.trace(), answer, run.now(), starved_s)
            still = stands_still(seen, series)
            late = answer.response is not None and answer.took_s > LONGEST_S + starved_s
            excused = (still or late) and starved_s >= STARVED * answer.took_s
            # A second time tells a hiccup of the machine's, or of the first connection, from what the node always does.
            again = excused or (tried == 1 and answer.response is not None and (still or late))
            if not again or run.exit is not None:
                break
    if seen.trace.exit is None and not excused and (answer.response is None or still):
        stuck, spins = await _stuck(bench, answer)
        return Lone(seen.trace, answer, seen.until, starved_s, stuck=stuck, spins=spins)
    return Lone(seen.trace, answer, seen.until, starved_s, excused)


def stands_still(seen: Lone, series: Sequence[Series]) -> bool:
    """Whether no way to see the timer's messages lets them go on as they should during the call."""
    right = [each for each in series if each.is_10_hz]
    return (
        bool(right)
        and seen.answer is not None
        and all(
            during(
                each,
                seen.trace.logs,
                seen.answer.asked_at,
                seen.answer.answered_at,
                until=seen.until,
                starved_s=seen.starved_s,
            ).fault
            for each in right
        )
    )


async def _next_tick(run: Run, series: Sequence[Series], answer: CallAnswer) -> None:
    """Wait for the first of the timer's messages after the call, and for others that come with it."""
    if not series:
        return

    def heard() -> bool:
        late = takewhile(lambda log: log.received_at > answer.answered_at, reversed(run.logs))
        return any(log.stamp > answer.answered_at and any(each.key.of(log) for each in series) for log in late)

    await run.until(heard, 1.3 * min(10.0, max(each.longest_s for each in series)) + 1.0)
    last = run.now() + 2 * IN_FLIGHT_S
    await run.until(lambda: run.now() >= last, 1.0)


async def _stuck(bench: Bench, before: CallAnswer) -> tuple[tuple[Frame, ...], bool]:
    """Call once more, only to see where the node is while it works on the call, and whether it spins at all."""
    async with bench.start(FILE) as run:
        bench.doing(0.9, "looking where the node is during a call")
        await appears(run, lambda: is_there(run.graph.services))
        spins = await run.parameters(2.0) is not None
        # A callback that answers is in the middle of its work; one that does not may come to a halt after it.
        into_s = WORK_S / 2 if before.response is not None else WORK_S + 0.5
        await run.call(SERVICE, TYPE, before.request, limit_s=into_s)
        return await run.stuck_at(), spins


async def trio(bench: Bench) -> Trio:
    """Three calls at once, each with its own sum."""
    async with bench.start(FILE) as run:
        bench.doing(0.1, f"waiting for {SERVICE}")
        if not await appears(run, lambda: is_there(run.graph.services)):
            return Trio(run.trace())
        bench.doing(0.3, f"calling {SERVICE} three times at once")
        starved_s = run.starved_s()
        answers = await _ask_at_once(run, _different())
        return Trio(run.trace(), answers, run.starved_s() - starved_s)


async def _ask_at_once(run: Run, requests: Sequence[Mapping[str, int]]) -> tuple[CallAnswer, ...]:
    """Make all calls at once; give up when none has been answered for as long as one call may take."""
    calls = [
        asyncio.create_task(run.call(SERVICE, TYPE, request, limit_s=len(requests) * ANSWER_S)) for request in requests
    ]
    asked_at = run.now()
    while (answered := _done(calls)) < len(calls):
        if not await run.until(lambda answered=answered: _done(calls) > answered, ANSWER_S):  # type: ignore[misc]
            break
    for call in calls:
        call.cancel()
    await asyncio.gather(*calls, return_exceptions=True)
    return tuple(
        CallAnswer(SERVICE, request, None, asked_at, run.now(), ANSWER_S) if call.cancelled() else call.result()
        for request, call in zip(requests, calls, strict=True)
    )


def _done(calls: Sequence[asyncio.Task[CallAnswer]]) -> int:
    return sum(call.done() for call in calls)


async def interrupted(bench: Bench) -> Interrupted:
    """Press Ctrl+C during a call."""
    async with bench.start(FILE) as run:
        bench.doing(0.1, f"waiting for {SERVICE}")
        called = await appears(run, lambda: is_there(run.graph.services))
        call = asyncio.create_task(run.call(SERVICE, TYPE, _operands(), limit_s=ANSWER_S))
        try:
            if called:
                bench.doing(0.4, f"calling {SERVICE}")
                due, starved_s = run.now() + INTO_CALL_S, run.starved_s()
                await run.until(lambda: call.done() or run.now() >= due + run.starved_s() - starved_s, 2 * INTO_CALL_S)
            trace = run.trace()
            bench.doing(0.7, "pressing Ctrl+C during the call")
            ended = await run.interrupt() if run.exit is None else None
        finally:
            call.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await call
        return Interrupted(trace, called, ended)


def _operands() -> Mapping[str, int]:
    """Operands by chance, so that no sum can be known beforehand."""
    return {"a": random.randint(-900, 900), "b": random.randint(1000, 9000)}


def _different() -> list[Mapping[str, int]]:
    """Operands for calls at once, whose sums all differ."""
    start = random.randint(-900, 900)
    return [{"a": start + 1000 * number, "b": random.randint(1, 900)} for number in range(CALLS)]
