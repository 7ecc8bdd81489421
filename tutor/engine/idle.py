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

    `next_wake(by)`: see `tutor.process.next_wake`. `for_s`: how long its threads must have been blocked, in seconds.
    `cpu_wait_s()`: how long we have waited for a CPU so far; within limits, that time does not count, since messages
    may have arrived that we have not seen.
    """

    def __init__(self, next_wake: Callable[[float], NextWake], cpu_wait_s: Callable[[], float], for_s: float) -> None:
        self._next_wake = next_wake
        self._cpu_wait_s = cpu_wait_s
        self._for_s = for_s
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
            waited_s = min(self._cpu_wait_s() - self._waited_before_s, MAX_EXTENSION_FACTOR * self._for_s)
            self._idle = now - self._idle_since >= self._for_s + waited_s
        return self._idle
