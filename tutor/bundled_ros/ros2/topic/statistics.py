"""The figures of `hz` and `delay`."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field

_PRINT_EVERY_NS = 1_000_000_000
_FIRST_AFTER_NS = 250_000_000  # anyone who watches would wait a whole second for nothing
_NS = 1e-9


@dataclass(slots=True)
class Rate:
    """The time between messages of a topic, over a window of them."""

    window: int
    between_ns: deque[int] = field(init=False)
    _last: int | None = None
    _printed: int | None = None

    def __post_init__(self) -> None:
        self.between_ns = deque(maxlen=self.window)

    def add(self, now_ns: int) -> str | None:
        """Count a message that arrived at this time; what to print, once a second."""
        if now_ns == 0:  # a simulation that has not begun, or has begun again
            return self._reset()
        if self._last is None or now_ns < self._last:
            self._last, self._printed = now_ns, None
            self.between_ns.clear()
            return None
        self.between_ns.append(now_ns - self._last)
        self._last = now_ns
        if self._printed is None:
            self._printed = now_ns - _PRINT_EVERY_NS + _FIRST_AFTER_NS
        elif now_ns >= self._printed + _PRINT_EVERY_NS:
            self._printed = now_ns
            return self._text()
        return None

    def _reset(self) -> str | None:
        had = bool(self.between_ns)
        self.between_ns.clear()
        return "time has reset, resetting counters" if had else None

    def _text(self) -> str:
        total = sum(self.between_ns)
        rate = len(self.between_ns) / (total * _NS) if total else 0.0
        return f"average rate: {rate:.3f}\n\t{spread(self.between_ns)}"


def spread(values_ns: deque[int]) -> str:
    """Least, greatest, standard deviation and count, in seconds."""
    count, mean = len(values_ns), sum(values_ns) / len(values_ns)
    deviation = math.sqrt(sum((value - mean) ** 2 for value in values_ns) / count)
    return (
        f"min: {min(values_ns) * _NS:.3f}s max: {max(values_ns) * _NS:.3f}s "
        f"std dev: {deviation * _NS:.5f}s window: {count}"
    )


def size(count: float, unit_of: float) -> str:
    """A number of bytes in the unit that suits `unit_of` bytes."""
    if unit_of < 1000:
        return f"{count:.0f} B"
    if unit_of < 1_000_000:
        return f"{count / 1000:.2f} KB"
    return f"{count / 1_000_000:.2f} MB"
