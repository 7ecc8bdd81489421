"""Checks of one machine take turns: two at once for each core.

A dozen at once on two cores would keep each other from running for so long that none could be judged.
"""

from __future__ import annotations

import asyncio
import os
import socket
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager

LIMIT_S = 300.0
"""A check that has waited this long goes on without a turn."""

_LOOK_EVERY_S = 0.1


def turn_socket() -> socket.socket:
    """What a turn is taken with; it counts among those of the network that this process is in now."""
    return socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)


@asynccontextmanager
async def turn(
    own: socket.socket | None = None, limit_s: float = LIMIT_S, on_wait: Callable[[], None] = lambda: None
) -> AsyncIterator[None]:
    """Wait until fewer checks are under way on this machine, and count as one until the end of the block.

    It ends with the process at the latest. `on_wait` is called once, where it has to wait.
    """
    deadline = time.monotonic() + limit_s
    with own or turn_socket() as held:
        if not _taken(held):
            on_wait()
            while time.monotonic() < deadline:
                await asyncio.sleep(_LOOK_EVERY_S)
                if _taken(held):
                    break
        yield


def _taken(held: socket.socket) -> bool:
    for number in range(2 * len(os.sched_getaffinity(0))):
        try:
            held.bind(f"\0ros-tutor-check-{number}")  # a name in the kernel alone, as that of a domain is
        except OSError:
            continue
        return True
    return False
