"""I2.3: how long to listen to a node until its timer can be recognised."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import takewhile

from checks.i2_3.ticks import HZ, Series, all_series
from tutor.judge.bench import Run
from tutor.judge.rates import TOLERANCE
from tutor.judge.trace import CallAnswer, LogRecord
from tutor.judge.waiting import IDLE_S, IN_FLIGHT_S

STARTUP_S = 1.5
"""Messages logged later than this after the first one are not part of the node's startup."""

LISTEN_S = 6.5
"""Long enough to recognise a wrong pace, or a silent timer: even one that logs every fiftieth tick would be heard."""

MESSAGE_GAP_S = 12.0
"""Long enough for a second message of a timer that logs every fiftieth tick."""

ANALYSIS_INTERVAL_S = 0.1
"""Minimum interval between analyses of the logs, which would be costly for each message of a flood."""


def logs_since(logs: Sequence[LogRecord], since: float) -> Sequence[LogRecord]:
    """The messages logged from `since` on: those of the node's startup, however regular, are no timer's."""
    return [log for log in logs if log.stamp >= since]


async def listen(run: Run, since: float, waited_before_s: float, is_up: Callable[[], bool]) -> None:
    """Wait until the logs from `since` on show the timer's pace.

    `waited_before_s`: how long the node and our process had waited for the CPU by then. The timeout starts at `since`
    while there is no log message, and again with the first one, but not before the node `is_up`.
    """
    was_silent, was_up = not logs_since(run.logs, since), is_up()
    began_at = since if was_silent and was_up else run.now()
    analysed_at, enough = 0.0, False

    def seen_enough() -> bool:
        nonlocal was_silent, was_up, began_at, analysed_at, enough
        if not was_up and is_up():
            began_at, was_up = run.now(), True
        if run.now() - analysed_at >= ANALYSIS_INTERVAL_S:
            analysed_at = run.now()
            logs = logs_since(run.logs, since)
            if was_silent and logs:
                began_at, was_silent = run.now(), False
            waited_s = run.node_cpu_wait_s() + run.our_cpu_wait_s() - waited_before_s
            enough = _is_pace_known(logs) or run.now() - began_at > _patience_s(logs) + waited_s
        return enough

    await run.until(seen_enough, 2 * MESSAGE_GAP_S, idle_s=IDLE_S)


def _is_pace_known(logs: Sequence[LogRecord]) -> bool:
    """Whether a 10 Hz timer has been observed long enough to be sure of its pace."""
    return any(
        series.is_10_hz and (series.span_s >= 3.5 or (series.span_s >= 1.8 and len(series.ticks) > 2))
        for series in all_series(logs)
    )


def _patience_s(logs: Sequence[LogRecord]) -> float:
    """How long to listen. A late message that belongs to no series may be the first of a timer that logs rarely."""
    frequent = [series for series in all_series(logs) if len(series.ticks) > 2]
    late = [log for log in logs if log.stamp - logs[0].stamp > STARTUP_S]
    if any(not any(series.key.of(log) for series in frequent) for log in late):
        return MESSAGE_GAP_S
    return LISTEN_S


def may_be_10_hz(series: Series, share: float) -> bool:
    """Whether this may be a 10 Hz timer whose node waited for the CPU for this share of the time."""
    return series.hz < HZ and series.hz / max(0.05, 1 - share) >= (1 - TOLERANCE) * HZ


async def next_tick(run: Run, series: Sequence[Series], answer: CallAnswer) -> None:
    """Wait for the timer's first message after the call, and for others that arrive together with it."""
    if not series:
        return

    def seen_enough() -> bool:
        late = takewhile(lambda log: log.received_at > answer.answered_at, reversed(run.logs))
        return any(log.stamp > answer.answered_at and any(each.key.of(log) for each in series) for log in late)

    await run.until(seen_enough, 1.3 * min(10.0, max(each.longest_s for each in series)) + 1.0)
    deadline = run.now() + 2 * IN_FLIGHT_S
    await run.until(lambda: run.now() >= deadline, 1.0)
