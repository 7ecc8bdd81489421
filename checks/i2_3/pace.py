"""I2.3: whether the timer keeps its pace during a call."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import pairwise

from checks.i2_3.ticks import Series
from tutor.judge.rates import TOLERANCE
from tutor.judge.trace import LogRecord

SLACK_S = 0.4
"""A pause is a gap, not jitter, if it exceeds the usual interval by the tolerance and this much."""


class Fault(Enum):
    """How the timer's pace is wrong during a call."""

    GAP = "gap"
    SLOW = "slow"
    FAST = "fast"


@dataclass(frozen=True, slots=True)
class TimerPace:
    """The timer's messages during one call. `count`: how many; `for_s`: the duration of the call.

    `longest_s`: the longest pause, including those at both ends; `hz`: ticks per second, None if there are too few
    messages to tell.
    """

    count: int
    expected: float
    for_s: float
    longest_s: float
    hz: float | None
    fault: Fault | None


def measure_timer(
    series: Series, logs: Iterable[LogRecord], asked_at: float, answered_at: float, *, until: float, cpu_wait_s: float
) -> TimerPace:
    """Measure the pace of the series during a call. `until`: end of the observation. Times in seconds since the epoch.

    A node that waited `cpu_wait_s` for the CPU may pause that much longer, and tick correspondingly less.
    """
    ticks = [tick for log in sorted(logs, key=lambda log: log.stamp) if (tick := series.key.of(log))]
    before = [tick for tick in ticks if tick.stamp < asked_at][-1:]
    after = [tick for tick in ticks if tick.stamp > answered_at][:1]
    within = [tick for tick in ticks if asked_at <= tick.stamp <= answered_at]
    around = [*before, *within, *after]
    edges = [
        *([] if before else [asked_at]),
        *(tick.stamp for tick in around),
        *([] if after else [max(until, answered_at)]),
    ]
    longest = max(b - a for a, b in pairwise(edges))
    allowed = (1 + TOLERANCE) * min(series.longest_s, 2 * series.interval_s) + SLACK_S + cpu_wait_s
    for_s = answered_at - asked_at
    expected = for_s / series.interval_s
    least = (1 - TOLERANCE) * max(0.0, for_s - cpu_wait_s) / series.interval_s - 1
    most = (1 + TOLERANCE) * expected + 1
    measurable = len(around) > 1 and around[-1].stamp - around[0].stamp >= 0.5 * for_s > 0.5
    hz = series.hz_in(around) if measurable else None
    fault = None
    if longest > allowed:
        fault = Fault.GAP
    elif len(within) < least or (hz and hz < (1 - TOLERANCE) * series.hz * max(0.1, 1 - cpu_wait_s / max(for_s, 0.1))):
        fault = Fault.SLOW
    elif len(within) > most or _has_burst(series, edges) or (hz and hz > (1 + TOLERANCE) * series.hz):
        fault = Fault.FAST
    return TimerPace(len(within), expected, for_s, longest, hz, fault)


def _has_burst(series: Series, stamps: Sequence[float]) -> bool:
    """Whether any half second contains far more messages than the timer's pace allows."""
    most = 1.5 * 0.5 / series.interval_s + 3
    return any(sum(start <= stamp < start + 0.5 for stamp in stamps) > most for start in stamps)
