"""The statistics of `hz`, `bw` and `delay`."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

from tutor.ros_model import Timing

_PRINT_PERIOD_NS = 1_000_000_000
_FIRST_AFTER_NS = 250_000_000  # the first output comes early: nobody likes to watch an empty screen for a second
_NS = 1e-9


@dataclass(slots=True)
class Rate:
    """The message rate of a topic over a window of messages."""

    window: int
    between_ns: deque[int] = field(init=False)
    _last_ns: int | None = None
    _printed_ns: int | None = None

    def __post_init__(self) -> None:
        self.between_ns = deque(maxlen=self.window)

    def add(self, now_ns: int) -> str | None:
        """Count a message that arrived at `now_ns`. Return the text to print once a second, else None."""
        if now_ns == 0:  # simulated time has not started yet or was reset
            return self._reset()
        if self._last_ns is None or now_ns < self._last_ns:
            self._last_ns, self._printed_ns = now_ns, None
            self.between_ns.clear()
            return None
        self.between_ns.append(now_ns - self._last_ns)
        self._last_ns = now_ns
        if self._printed_ns is None:
            self._printed_ns = now_ns - _PRINT_PERIOD_NS + _FIRST_AFTER_NS
        elif now_ns >= self._printed_ns + _PRINT_PERIOD_NS:
            self._printed_ns = now_ns
            return self._format()
        return None

    def _reset(self) -> str | None:
        had_samples = bool(self.between_ns)
        self.between_ns.clear()
        return "time has reset, resetting counters" if had_samples else None

    def _format(self) -> str:
        timing = Timing.of(self.between_ns, _NS)
        return f"average rate: {timing.rate_hz:.3f}\n\t{spread(timing)}"


def spread(timing: Timing) -> str:
    """Format the minimum, maximum and standard deviation, in seconds, and the count."""
    return (
        f"min: {timing.shortest_s:.3f}s max: {timing.longest_s:.3f}s "
        f"std dev: {timing.deviation_s:.5f}s window: {timing.periods}"
    )


def format_size(count: float, unit_of: float) -> str:
    """Format a number of bytes in the unit that suits `unit_of` bytes."""
    if unit_of < 1000:
        return f"{count:.0f} B"
    if unit_of < 1_000_000:
        return f"{count / 1000:.2f} KB"
    return f"{count / 1_000_000:.2f} MB"
