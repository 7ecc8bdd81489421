"""I2.3: how long to listen to a node, so that its timer can be recognised."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import takewhile

from checks.i2_3.ticks import HZ, Series, all_series
from tutor.judge.bench import Run
from tutor.judge.rates import TOLERANCE
from tutor.judge.trace import CallAnswer, LogRecord
from tutor.judge.waiting import IDLE_S, IN_FLIGHT_S

UP_S = 1.5
"""What a node logs later than this after its first sign of life is not a greeting."""

LISTEN_S = 6.5
"""Time enough to see that what comes is of another pace, or that nothing comes, not even from a tick in fifty."""

RARE_S = 12.0
"""Time enough for a second message of a timer that logs every fiftieth tick."""

LOOK_EVERY_S = 0.1


def logs_since(logs: Sequence[LogRecord], since: float) -> Sequence[LogRecord]:
    """What was logged from then on: what a node logs of its own start, however steadily, comes from no timer."""
    return [log for log in logs if log.stamp >= since]


async def listen(run: Run, since: float, is_up: Callable[[], bool]) -> None:
    """Wait until the logs `since` then tell all about the timer. It is given time from when the node `is_up`."""
    up_at, lost_s = run.now(), run.node_cpu_wait_s() + run.our_cpu_wait_s()
    was_up, looked_at, enough = is_up(), 0.0, False

    def seen_enough() -> bool:
        nonlocal up_at, was_up, looked_at, enough
        if not was_up and is_up():
            up_at, was_up = run.now(), True
        if run.now() - looked_at >= LOOK_EVERY_S:  # not at each of a thousand messages
            looked_at = run.now()
            logs = logs_since(run.logs, since)
            enough = (
                _told(logs)
                or run.now() - up_at > _patience_s(logs) + run.node_cpu_wait_s() + run.our_cpu_wait_s() - lost_s
            )
        return enough

    await run.until(seen_enough, 2 * RARE_S, idle_s=IDLE_S)


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


def may_be_10_hz(series: Series, share: float) -> bool:
    """Whether a timer of 10 Hz looks like this where the machine kept it from running for this share of the time."""
    return series.hz < HZ and series.hz / max(0.05, 1 - share) >= (1 - TOLERANCE) * HZ


async def next_tick(run: Run, series: Sequence[Series], answer: CallAnswer) -> None:
    """Wait for the first of the timer's messages after the call, and for others that come with it."""
    if not series:
        return

    def seen_enough() -> bool:
        late = takewhile(lambda log: log.received_at > answer.answered_at, reversed(run.logs))
        return any(log.stamp > answer.answered_at and any(each.key.of(log) for each in series) for log in late)

    await run.until(seen_enough, 1.3 * min(10.0, max(each.longest_s for each in series)) + 1.0)
    last = run.now() + 2 * IN_FLIGHT_S
    await run.until(lambda: run.now() >= last, 1.0)
