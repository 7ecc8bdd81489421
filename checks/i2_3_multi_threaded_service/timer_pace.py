"""I2.3: whether the timer keeps its pace during a call, and when to call again to be sure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from itertools import pairwise

from checks.i2_3_multi_threaded_service.calls import HARDLY_WAITED_S, LONGEST_S, Call
from checks.i2_3_multi_threaded_service.timer_logs import Series
from tutor.judge.rates import TOLERANCE
from tutor.judge.trace import LogRecord
from tutor.judge.wording import counted

SLACK_S = 0.4
"""A pause is a gap, not jitter, if it exceeds the usual interval by the tolerance and this much."""

BLOCKED_SHARE = 0.75
"""A timer that pauses for less than this share of a call is not blocked by the whole call."""

NEGLIGIBLE_S = 0.2
"""CPU wait, in seconds, that is too short to slow anything."""

MAX_PAUSE_ALLOWANCE_S = 1.0
"""Maximum allowance for a timer's pause. With more, one that is blocked for 3 s would pass."""

TRIES, MAX_TRIES = 4, 8
"""How often a call is made that the machine may have slowed: at most `TRIES` times, or `MAX_TRIES` if all were slowed.

A machine is seldom so busy for half a minute.
"""


class Fault(Enum):
    """How the timer's pace is wrong during a call; the value says it in a word."""

    GAP = "pauses"
    SLOW = "slow"
    FAST = "fast"


@dataclass(frozen=True, slots=True)
class TimerPace:
    """The timer's messages during one call. `count`: how many; `for_s`: the duration of the call.

    `longest_s`: the longest pause, including those at both ends; `hz`: ticks per second, None if there are too few
    messages to tell.
    """

    count: int
    for_s: float
    longest_s: float
    hz: float | None
    fault: Fault | None

    @property
    def stops(self) -> bool:
        """Whether the timer stands still for most of the call."""
        return self.fault is Fault.GAP and (self.count <= 1 or self.longest_s >= BLOCKED_SHARE * self.for_s)

    def beside(self, series: Series) -> str:
        """The pace in words, beside that of the series outside the call."""
        rate = f", {self.hz:.1f} ticks/s" if self.hz is not None and self.fault is not Fault.GAP else ""
        return (
            f"during the call of {self.for_s:.1f} s: {counted(self.count, 'message')}{rate}, "
            f"the longest pause {self.longest_s:.2f} s (outside {series.longest_s:.2f} s)"
        )


def measure_timer(
    series: Series, logs: Sequence[LogRecord], call: Call, max_allowance_s: float = MAX_PAUSE_ALLOWANCE_S
) -> TimerPace:
    """Measure the pace of the series during a call.

    A node that waited for a CPU may pause that much longer, at most `max_allowance_s`, and tick correspondingly less.
    """
    asked_at, answered_at, allowance_s = (
        call.answer.asked_at,
        call.answer.answered_at,
        min(call.cpu_wait_s, max_allowance_s),
    )
    ticks = [tick for log in sorted(logs, key=lambda log: log.stamp) if (tick := series.key.of(log))]
    before = [tick for tick in ticks if tick.stamp < asked_at][-1:]
    after = [tick for tick in ticks if tick.stamp > answered_at][:1]
    within = [tick for tick in ticks if asked_at <= tick.stamp <= answered_at]
    around = [*before, *within, *after]
    begin, end = [] if before else [asked_at], [] if after else [max(call.until, answered_at)]
    stamps = [*begin, *(tick.stamp for tick in around), *end]
    longest = max(b - a for a, b in pairwise(stamps))
    allowed = (1 + TOLERANCE) * min(series.longest_s, 2 * series.interval_s) + SLACK_S + allowance_s
    for_s = call.answer.took_s
    least = (1 - TOLERANCE) * max(0.0, for_s - allowance_s) / series.interval_s - 1
    most = (1 + TOLERANCE) * for_s / series.interval_s + 1
    measurable = len(around) > 1 and around[-1].stamp - around[0].stamp >= 0.5 * for_s > 0.5
    hz = series.hz_in(around) if measurable else None
    running_share = max(0.1, 1 - allowance_s / max(for_s, 0.1))
    fault = None
    if longest > allowed:
        fault = Fault.GAP
    elif len(within) < least or (hz and hz < (1 - TOLERANCE) * series.hz * running_share):
        fault = Fault.SLOW
    elif len(within) > most or _has_burst(series, stamps) or (hz and hz > (1 + TOLERANCE) * series.hz):
        fault = Fault.FAST
    return TimerPace(len(within), for_s, longest, hz, fault)


def _has_burst(series: Series, stamps: Sequence[float]) -> bool:
    """Whether any half second contains far more messages than the timer's pace allows."""
    most = 1.5 * 0.5 / series.interval_s + 3
    return any(sum(start <= stamp < start + 0.5 for stamp in stamps) > most for start in stamps)


@dataclass(frozen=True)
class Watch:
    """What a run has logged, and the possible readings of its timer's messages."""

    logs: Sequence[LogRecord]
    series: tuple[Series, ...]

    @property
    def right(self) -> list[Series]:
        """The readings as a 10 Hz timer."""
        return [series for series in self.series if series.is_10_hz]

    def paces(self, call: Call) -> list[TimerPace]:
        """The timer's pace during this call, by each reading as a 10 Hz timer."""
        return [measure_timer(series, self.logs, call) for series in self.right]

    def is_disturbed(self, call: Call) -> bool:
        """Whether the timer's messages lose their pace during this call in every possible reading of them."""
        paces = self.paces(call)
        return bool(paces) and all(pace.fault for pace in paces)

    def passes_by_allowance(self, call: Call) -> bool:
        """Whether the timer only counts as undisturbed during this call because of the allowance for the machine."""
        if call.cpu_wait_s <= NEGLIGIBLE_S or self.is_disturbed(call):
            return False
        return self.is_disturbed(replace(call, cpu_wait_s=NEGLIGIBLE_S))

    def is_slowed(self, call: Call) -> bool:
        """Whether the machine may be to blame for a disturbed timer: its pace is acceptable with twice the CPU wait."""
        twice_s = 2 * call.cpu_wait_s
        doubled = replace(call, cpu_wait_s=twice_s)
        return call.slowed and any(
            not measure_timer(series, self.logs, doubled, twice_s).fault for series in self.right
        )

    def is_stopped(self, call: Call) -> bool:
        """Whether no timer logs anything during this call, although two messages are due even without the CPU wait."""
        begin, end = call.answer.asked_at + NEGLIGIBLE_S, call.answer.answered_at - NEGLIGIBLE_S
        if not self.series or 2 * max(series.longest_s for series in self.series) > end - begin - call.cpu_wait_s:
            return False
        return not any(begin <= log.stamp <= end and series.key.of(log) for log in self.logs for series in self.series)

    def needs_repeat(self, calls: Sequence[Call], most: int) -> bool:
        """Whether to call again, to tell effects of the machine, or of the first connection, from the node's own.

        A timer that stops for the whole call is the node's. More than `TRIES` calls, up to `most`, are only made if
        the machine may have slowed all so far.
        """
        call, tried = calls[-1], len(calls)
        if not call.answered:
            return False
        disturbed, late = self.is_disturbed(call), call.answer.took_s > LONGEST_S
        if tried == 1:
            stopped = disturbed and not late and self.is_stopped(call)
            return not stopped and (disturbed or late or self.passes_by_allowance(call))
        slowed, late = disturbed and self.is_slowed(call), late and call.nearly_in_time
        if tried < TRIES:
            return slowed or (late and call.cpu_wait_s > HARDLY_WAITED_S) or self.passes_by_allowance(call)
        return tried < most and (slowed or (late and all(call.slowed for call in calls)))
