"""Waiting for what is to be seen. A crowded machine is given back the time for which it kept us from looking."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable

from tutor.process.cpu_wait import own_cpu_time

LOOK_AFTER_S = 0.01
LOOK_EVERY_S = 0.1
"""Between two looks, at most: one at a whole screen takes as long as a node needs the core for, to get there."""


async def seen_within(seen: Callable[[], bool], limit_s: float) -> bool:
    """Whether it is there within `limit_s` seconds; those in which we were able to run, but not let, do not count.

    A process that looks this often, and sleeps this little in between, waits for the CPU as long as any on the machine.
    """
    began, waited, pause = time.monotonic(), own_cpu_time().waited_s, LOOK_AFTER_S
    while not seen():
        took = time.monotonic() - began
        if took > limit_s and took - (own_cpu_time().waited_s - waited) > limit_s:
            return False
        await asyncio.sleep(pause)
        pause = min(1.5 * pause, LOOK_EVERY_S)
    return True
