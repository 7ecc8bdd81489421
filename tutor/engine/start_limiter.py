"""Limits how many processes start at a time; those with the longest scenarios go first.

A start costs about half a second of CPU time: for Python, rclpy, its participant, and ours that observes it. If thirty
processes start at once on two cores, none is up before all are, and only then does each begin to wait for what takes
real time, such as its messages. One after the other, the first is up after half a second, and waits while the rest
start.
"""

from __future__ import annotations

import asyncio
import heapq
import itertools
import os
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager

from tutor.engine.alone import RunningScenarios

EXTRA_SLOTS = 1
"""Concurrent starts beyond one per core, since a start also waits for the disk and for discovery."""

GATHER_ITERATIONS = 5
"""Requests within this many iterations of the event loop are sorted together: a scenario may request several starts."""


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
