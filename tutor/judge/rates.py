"""Rates, measured on source timestamps."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from tutor.judge.trace import Sample

TOLERANCE = 0.2
"""A rate is right within this fraction of what was asked for."""

WINDOW_FILLED = 0.6
"""The first and the last message of a window may be up to a period away from its ends."""

FAR_ABOVE = 1.5
"""Messages that were held up and come together make a rate higher than it is, but not this many times."""

EVEN_SHARE = 0.5
"""Of messages that come one by one, half are further apart than this share of the mean period, jitter and all."""

MIN_FOR_BURSTS = 5
"""Fewer messages do not show whether they come in bursts."""


@dataclass(frozen=True, slots=True)
class Rate:
    """A measured rate: `samples` messages over `span_s` seconds, from the first one's source time to the last one's.

    `median_s`: how far two messages are apart, in the middle of all; None where nothing is known of it.
    """

    hz: float
    samples: int
    span_s: float
    median_s: float | None = None

    @property
    def in_bursts(self) -> bool:
        """Whether most messages come right after another: as many as asked for, but not at that rate."""
        return self.samples >= MIN_FOR_BURSTS and self.median_s is not None and self.median_s * self.hz < EVEN_SHARE

    def agrees(self, asked_hz: float) -> bool:
        """Whether this is the rate that was asked for, within the tolerance."""
        return abs(self.hz - asked_hz) <= TOLERANCE * asked_hz and not self.in_bursts

    def covers(self, window_s: float) -> bool:
        """Whether the messages fill most of a window that is long enough to tell this rate, not a burst in it."""
        return self.span_s >= WINDOW_FILLED * window_s

    def is_far_above(self, asked_hz: float, window_s: float) -> bool:
        """Whether it is so much faster, in a window that is long enough, that no hiccup of the machine explains it."""
        return self.hz > FAR_ABOVE * asked_hz and self.covers(window_s) and not self.in_bursts

    def __str__(self) -> str:
        bursts = ", in bursts" if self.in_bursts else ""
        return f"{self.hz:.2f} Hz ({self.samples} messages in {self.span_s:.2f} s{bursts})"


def measure(samples: Sequence[Sample]) -> Rate | None:
    """The rate of these samples; None for fewer than two, or where they bear one and the same time."""
    times = sorted(sample.source_time for sample in samples)
    if len(times) < 2 or times[-1] <= times[0]:
        return None
    span = times[-1] - times[0]
    return Rate((len(times) - 1) / span, len(times), span, statistics.median(b - a for a, b in pairwise(times)))


def describe(rate: Rate | None, samples: int) -> str:
    """A rate in words, also where there were too few messages to have one."""
    if rate is not None:
        return str(rate)
    return "no message" if samples == 0 else f"only {samples} message{'s' if samples > 1 else ''}"
