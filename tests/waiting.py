"""Wait for conditions, with a timeout that does not count the time for which a busy machine kept us from running."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable

from tutor.process.cpu_wait import own_cpu_time

FIRST_POLL_S = 0.01
MAX_POLL_S = 0.1
"""Longest pause between polls. Polling a whole screen takes so much CPU that polling faster would slow the node."""


async def wait_for(condition: Callable[[], bool], limit_s: float) -> bool:
    """Wait until `condition()`, for at most `limit_s` seconds, and return whether it came true.

    Time in which we were runnable but got no CPU does not count. Polling this often, we wait for the CPU about as long
    as any process on the machine.
    """
    began, waited, pause = time.monotonic(), own_cpu_time().waited_s, FIRST_POLL_S
    while not condition():
        took = time.monotonic() - began
        if took > limit_s and took - (own_cpu_time().waited_s - waited) > limit_s:
            return False
        await asyncio.sleep(pause)
        pause = min(1.5 * pause, MAX_POLL_S)
    return True
