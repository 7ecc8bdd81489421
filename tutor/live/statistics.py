"""Count, rate and jitter of a topic, from source timestamps and sequence numbers. Pure."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

from tutor.ros_model import Timing

WINDOW_S = 5.0
"""Rate and jitter are measured over a window this long..."""

MIN_PERIODS = 10
"""... or over this many periods, if a topic is slow."""

_BUCKET_S = 0.25
_PAUSE_FACTOR = 8.0
"""A period of more than this many times the mean, and longer than the window, is a pause: measuring restarts."""


@dataclass(slots=True)
class _Bucket:
    """Sums over the periods that ended within `_BUCKET_S`, so that the window needs little memory at any rate."""

    begin: float
    end: float
    periods: int = 0
    total: float = 0.0
    squares: float = 0.0
    shortest: float = math.inf
    longest: float = 0.0

    def add(self, period: float, end: float) -> None:
        self.end = end
        self.periods += 1
        self.total += period
        self.squares += period * period
        self.shortest = min(self.shortest, period)
        self.longest = max(self.longest, period)


class TopicStatistics:
    """Statistics of one topic. `count` is the number of messages, `missing` that of skipped sequence numbers."""

    def __init__(self) -> None:
        self.count = 0
        self.missing = 0
        self._buckets: deque[_Bucket] = deque()
        self._last_stamp: float | None = None
        self._last_number: int | None = None

    def add(self, stamps: Sequence[float], numbers: Sequence[int | None]) -> None:
        """Add messages by their source timestamps (s) and publisher sequence numbers, in order of arrival."""
        self.count += len(stamps)
        for number in numbers:
            self._add_number(number)
        for stamp in sorted(stamps):  # messages of several publishers may arrive out of order
            self._add_stamp(stamp)

    def timing(self) -> Timing | None:
        """Return the timing over the window; None before the first period."""
        periods = sum(bucket.periods for bucket in self._buckets)
        if periods == 0:
            return None
        mean = sum(bucket.total for bucket in self._buckets) / periods
        variance = sum(bucket.squares for bucket in self._buckets) / periods - mean * mean
        return Timing(
            periods=periods,
            mean_s=mean,
            deviation_s=math.sqrt(max(0.0, variance)),
            shortest_s=min(bucket.shortest for bucket in self._buckets),
            longest_s=max(bucket.longest for bucket in self._buckets),
        )

    def _add_number(self, number: int | None) -> None:
        # A smaller number comes from another publisher, or a restarted one: it says nothing about loss.
        if number is not None and self._last_number is not None and number > self._last_number:
            self.missing += number - self._last_number - 1
        self._last_number = number

    def _add_stamp(self, stamp: float) -> None:
        last, self._last_stamp = self._last_stamp, max(stamp, self._last_stamp or stamp)
        if last is None:
            return
        period = max(0.0, stamp - last)
        if period > WINDOW_S and (known := self.timing()) and period > _PAUSE_FACTOR * known.mean_s:
            self._buckets.clear()
            return
        if not self._buckets or stamp - self._buckets[-1].begin >= _BUCKET_S:
            self._buckets.append(_Bucket(stamp, stamp))
            self._drop_old_buckets(stamp)
        self._buckets[-1].add(period, stamp)

    def _drop_old_buckets(self, now: float) -> None:
        periods = sum(bucket.periods for bucket in self._buckets)
        while self._buckets[0].end < now - WINDOW_S and periods - self._buckets[0].periods >= MIN_PERIODS:
            periods -= self._buckets.popleft().periods
