"""Message rates, measured from source timestamps."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from tutor.judge.trace import Sample
from tutor.judge.wording import counted

TOLERANCE = 0.2
"""A rate is right within this fraction of the requested rate."""

WINDOW_FILLED = 0.6
"""Minimum share of a window that messages must span; the first and last may be up to a period away from its ends."""

FAR_ABOVE = 1.5
"""Messages that were delayed and arrive together inflate a measured rate, but not by this factor."""

EVEN_SHARE = 0.5
"""Evenly spaced messages have a median gap of more than this share of the mean period, even with jitter."""

EVEN_RATIO = 1.1
"""Gaps between evenly sent messages differ by less than this ratio; a machine that delays some makes them uneven."""

MIN_EVEN = 4
"""Minimum number of messages that can show whether they are sent evenly."""

MIN_FOR_BURSTS = 5
"""Minimum number of messages that can show whether they come in bursts."""


@dataclass(frozen=True, slots=True)
class Rate:
    """A measured rate: `samples` messages over `span_s` seconds, from the first source time to the last.

    `median_s`: the median gap between consecutive messages in seconds; None if unknown.
    """

    hz: float
    samples: int
    span_s: float
    median_s: float | None = None

    @property
    def in_bursts(self) -> bool:
        """Whether most messages directly follow another one: the mean may be right, but the spacing is not."""
        return self.samples >= MIN_FOR_BURSTS and self.median_s is not None and self.median_s * self.hz < EVEN_SHARE

    def agrees_with(self, asked_hz: float) -> bool:
        """Whether this is the requested rate, within the tolerance, and not in bursts."""
        return abs(self.hz - asked_hz) <= TOLERANCE * asked_hz and not self.in_bursts

    def covers(self, window_s: float) -> bool:
        """Whether the messages span most of a window, and so are not just a burst within it."""
        return self.span_s >= WINDOW_FILLED * window_s

    def is_far_above(self, asked_hz: float, window_s: float) -> bool:
        """Whether the rate is too far above the requested one, over most of a window, for a hiccup of the machine."""
        return self.hz > FAR_ABOVE * asked_hz and self.covers(window_s) and not self.in_bursts

    def __str__(self) -> str:
        bursts = ", in bursts" if self.in_bursts else ""
        return f"{self.hz:.2f} Hz ({self.samples} messages in {self.span_s:.2f} s{bursts})"


def measure(samples: Sequence[Sample]) -> Rate | None:
    """The rate of these samples; None for fewer than two, or if all have the same source time."""
    times = sorted(sample.source_time for sample in samples)
    if len(times) < 2 or times[-1] <= times[0]:
        return None
    span = times[-1] - times[0]
    return Rate((len(times) - 1) / span, len(times), span, statistics.median(b - a for a, b in pairwise(times)))


def are_even(samples: Sequence[Sample]) -> bool:
    """Whether there are enough samples to see that they are sent evenly: then no hiccup has changed their rate."""
    times = sorted(sample.source_time for sample in samples)
    gaps = [later - earlier for earlier, later in pairwise(times)]
    return len(times) >= MIN_EVEN and max(gaps) < EVEN_RATIO * min(gaps)


def describe(rate: Rate | None, samples: int) -> str:
    """A rate in words, also when there were too few messages to measure one."""
    if rate is not None:
        return str(rate)
    return f"only {counted(samples, 'message')}" if samples else "no message"
