"""Detect an idle process: a node whose threads are all blocked, none of them with a timeout, sends nothing more."""

from __future__ import annotations

import time
from collections.abc import Callable

from tutor.process import NextWake
from tutor.process.cpu_wait import MAX_EXTENSION_FACTOR

POLL_S = 0.1
"""Minimum interval between two readings of the process's threads."""


class IdleDetector:
    """Detects whether a process is idle.

    `next_wake(by)`: see `tutor.process.next_wake`. `for_s`: how long its threads must have been blocked, in seconds;
    `lossless_s`: the same if nothing can have been lost on its way, as `may_have_lost()` tells. `cpu_wait_s()`: how
    long we have waited for a CPU so far; within limits, that time does not count, since messages may have arrived that
    we have not seen.
    """

    def __init__(
        self,
        next_wake: Callable[[float], NextWake],
        cpu_wait_s: Callable[[], float],
        for_s: float,
        *,
        lossless_s: float,
        may_have_lost: Callable[[], bool],
    ) -> None:
        self._next_wake = next_wake
        self._cpu_wait_s = cpu_wait_s
        self._for_s = for_s
        self._lossless_s = min(for_s, lossless_s)
        self._may_have_lost = may_have_lost
        self._read_at = 0.0
        self._timeslices = -1
        self._idle_since = self._waited_before_s = 0.0
        self._idle = False

    def is_idle_until(self, deadline: float) -> bool:
        """Whether the process is idle and will stay so until `deadline` (seconds since the epoch). Must be polled."""
        now = time.monotonic()
        if now - self._read_at < POLL_S:
            return self._idle
        self._read_at = now
        wake = self._next_wake(deadline)
        if wake.at <= deadline or wake.timeslices != self._timeslices:
            self._timeslices = wake.timeslices
            self._idle_since, self._waited_before_s = now, self._cpu_wait_s()
            self._idle = False
        else:
            idle_s = now - self._idle_since
            self._idle = idle_s >= self._extended(self._lossless_s) and (
                idle_s >= self._extended(self._for_s) or not self._may_have_lost()
            )
        return self._idle

    def _extended(self, for_s: float) -> float:
        return for_s + min(self._cpu_wait_s() - self._waited_before_s, MAX_EXTENSION_FACTOR * for_s)
