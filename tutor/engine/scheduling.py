"""When something may run on this machine: checks take turns, a few processes start at a time, a scenario runs alone.

At most two checks per core run at a time: a dozen at once on two cores would starve each other so badly that none
could be judged. A start costs about half a second of CPU time: for Python, rclpy, its participant, and ours that
observes it. If thirty processes start at once on two cores, none is up before all are, and only then does each begin to
wait for what takes real time, such as its messages. One after the other, the first is up after half a second, and waits
while the rest start.
"""

from __future__ import annotations

import asyncio
import contextlib
import heapq
import itertools
import os
import socket
import time
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager

TURN_LIMIT_S = 300.0
"""Maximum wait for a turn: after it, a check runs without one."""

EXTRA_SLOTS = 1
"""Concurrent starts beyond one per core, since a start also waits for the disk and for discovery."""

GATHER_ITERATIONS = 5
"""Requests within this many iterations of the event loop are sorted together: a scenario may request several starts."""

_TURN_POLL_S = 0.1

_ALONE_POLL_S = 0.05
"""Poll interval of a scenario that waits for all others to end."""

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
    unbound: socket.socket | None = None, limit_s: float = TURN_LIMIT_S, on_wait: Callable[[], None] = lambda: None
) -> AsyncIterator[None]:
    """Wait for a turn, and hold it until the end of the block, or of the process.

    `unbound`: the socket to take it with (default: a new `turn_socket()`). `on_wait` is called once if there is a wait.
    """
    deadline = time.monotonic() + limit_s
    with unbound or turn_socket() as held:
        if not _take_turn(held):
            on_wait()
            while time.monotonic() < deadline:
                await asyncio.sleep(_TURN_POLL_S)
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


class StartLimiter:
    """Lets `slots` processes start at a time (default: one per core available to us, plus `EXTRA_SLOTS`).

    `scenarios`: the running scenarios of all checks that share this limiter.
    """

    def __init__(self, slots: int | None = None) -> None:
        self._free = slots or len(os.sched_getaffinity(0)) + EXTRA_SLOTS
        self._waiting: list[tuple[float, int, asyncio.Future[None]]] = []
        self._number = itertools.count()
        self.scenarios = RunningScenarios()

    @asynccontextmanager
    async def slot(self, expected_s: float) -> AsyncIterator[Callable[[], None]]:
        """Wait for a slot; the request with the greatest `expected_s` goes first.

        Yield a function to call once the process is up. That frees the slot, and so does the end of the block.
        """
        await self._acquire(expected_s)
        held = True

        def up() -> None:
            nonlocal held
            if held:
                held = False
                self._release()

        try:
            yield up
        finally:
            up()

    async def _acquire(self, expected_s: float) -> None:
        turn = asyncio.get_running_loop().create_future()
        if not self._waiting:
            self._grant_after(GATHER_ITERATIONS)
        heapq.heappush(self._waiting, (-expected_s, next(self._number), turn))
        try:
            await turn
        except asyncio.CancelledError:
            if turn.done() and not turn.cancelled():  # it was granted a slot in the same iteration
                self._release()
            raise

    def _grant_after(self, iterations: int) -> None:
        if iterations:
            asyncio.get_running_loop().call_soon(self._grant_after, iterations - 1)
        else:
            self._grant_slots()

    def _grant_slots(self) -> None:
        while self._free and self._waiting:
            _, _, turn = heapq.heappop(self._waiting)
            if not turn.done():
                turn.set_result(None)
                self._free -= 1

    def _release(self) -> None:
        self._free += 1
        self._grant_slots()


class RunningScenarios:
    """Counts the running scenarios, so that one that must run alone can wait for all others to end."""

    def __init__(self) -> None:
        self._count = 0
        self._alone_lock = asyncio.Lock()

    @asynccontextmanager
    async def running(self, *, alone: bool = False) -> AsyncIterator[None]:
        """Count as running within the block; with `alone`, first wait until no other scenario is running."""
        if alone:
            async with self._alone_lock:
                while self._count:
                    await asyncio.sleep(_ALONE_POLL_S)
                self._count += 1
        else:
            self._count += 1
        try:
            yield
        finally:
            self._count -= 1

    @contextmanager
    def waiting(self) -> Iterator[None]:
        """Do not count as running within the block: this scenario waits for another, which may have to run alone."""
        self._count -= 1
        try:
            yield
        finally:
            self._count += 1
