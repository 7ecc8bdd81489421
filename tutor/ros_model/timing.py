"""Statistics of the periods between messages."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Timing:
    """Statistics of periods between messages, or of other durations."""

    periods: int
    mean_s: float
    deviation_s: float
    shortest_s: float
    longest_s: float

    @classmethod
    def of(cls, durations: Collection[float], unit_s: float = 1.0) -> Timing:
        """Compute the statistics of at least one duration, in units of `unit_s` seconds."""
        count, total = len(durations), sum(durations)
        # Exact for whole numbers, such as nanoseconds: the ages of messages without a stamp are 50 years and a moment.
        variance = max(0.0, (count * math.sumprod(durations, durations) - total * total) / count**2)
        mean, deviation, shortest, longest = total / count, math.sqrt(variance), min(durations), max(durations)
        return cls(count, mean * unit_s, deviation * unit_s, shortest * unit_s, longest * unit_s)

    @property
    def rate_hz(self) -> float:
        """Messages per second; 0 if all came at the same instant."""
        return 1 / self.mean_s if self.mean_s > 0 else 0.0
