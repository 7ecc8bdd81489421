"""Checks on one machine take turns: at most two per core run at a time.

A dozen checks at once on two cores would starve each other so badly that none could be judged.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import socket
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager

LIMIT_S = 300.0
"""Maximum wait for a turn: after it, a check runs without one."""

_POLL_S = 0.1

_KEPT = "_ROS_TUTOR_TURN_SOCKET"


def turn_socket() -> socket.socket:
    """Create the socket with which to take a turn, among the checks in this process's current network namespace."""
    return socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)


def kept_turn_socket() -> socket.socket:
    """Create such a socket, or return that which this process had made before it restarted itself elsewhere."""
    number = os.environ.pop(_KEPT, "")
    if number.isdecimal():
        with contextlib.suppress(OSError):
            return socket.socket(fileno=int(number))
    made = turn_socket()
    made.set_inheritable(True)
    os.environ[_KEPT] = str(made.fileno())
    return made


@asynccontextmanager
async def turn(
    unbound: socket.socket | None = None, limit_s: float = LIMIT_S, on_wait: Callable[[], None] = lambda: None
) -> AsyncIterator[None]:
    """Wait for a turn, and hold it until the end of the block, or of the process.

    `unbound`: the socket to take it with (default: a new `turn_socket()`). `on_wait` is called once if there is a wait.
    """
    deadline = time.monotonic() + limit_s
    with unbound or turn_socket() as held:
        if not _take_turn(held):
            on_wait()
            while time.monotonic() < deadline:
                await asyncio.sleep(_POLL_S)
                if _take_turn(held):
                    break
        yield


def _take_turn(held: socket.socket) -> bool:
    for number in range(2 * len(os.sched_getaffinity(0))):
        try:
            held.bind(f"\0ros-tutor-check-{number}")  # an abstract name, as for domain ids
        except OSError:
            continue
        return True
    return False
