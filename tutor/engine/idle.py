"""Whether what is waited for can still come: a node that does nothing, and waits for no time, sends no more."""

from __future__ import annotations

import time
from collections.abc import Callable

from tutor.process import NextWake

LOOK_EVERY_S = 0.1


class Idle:
    """Watches a process that somebody waits for.

    `for_s`: how long it must have done nothing; `cpu_wait_s()`: for how long we were not let run so far, in which its
    messages may have come in unseen.
    """

    def __init__(self, next_wake: Callable[[], NextWake], cpu_wait_s: Callable[[], float], for_s: float) -> None:
        self._next_wake = next_wake
        self._cpu_wait_s = cpu_wait_s
        self._for_s = for_s
        self._looked = 0.0
        self._timeslices = -1
        self._since = self._waited_s = 0.0
        self._idle = False

    def until(self, deadline: float) -> bool:
        """Whether it is idle, and will be until then (seconds since the epoch). To be asked again and again."""
        now = time.monotonic()
        if now - self._looked < LOOK_EVERY_S:
            return self._idle
        self._looked = now
        seen = self._next_wake()
        if seen.at <= deadline or seen.timeslices != self._timeslices:
            self._timeslices = seen.timeslices
            self._since, self._waited_s = now, self._cpu_wait_s()
            self._idle = False
        else:
            self._idle = now - self._since >= self._for_s + self._cpu_wait_s() - self._waited_s
        return self._idle
