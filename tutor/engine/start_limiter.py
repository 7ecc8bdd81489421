"""Limits how many processes start at a time; those whose scenario takes longest go first.

A start costs about half a second of CPU time: Python, rclpy, a participant of its own, and ours to watch it.
Thirty starts at once on two cores would all be up only when the last one is, and each then begins to wait for what
physics asks of it. One after the other, the first is up in half a second, and waits while the others start.
"""

from __future__ import annotations

import asyncio
import heapq
import itertools
import os
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager

from tutor.engine.alone import ScenariosAtWork

MORE_THAN_CORES = 1
"""Starts in flight beyond one for each core: a start waits, too, for the disk and for its peers."""

ITERATIONS = 5
"""Those who ask within this many iterations of the event loop ask at once: a scenario may begin several starts."""


class StartLimiter:
    """How many may start at a time: `slots` (by default one for each core that is ours, and one more).

    `scenarios`: those that are at work, of all checks that share this.
    """

    def __init__(self, slots: int | None = None) -> None:
        self._free = slots or len(os.sched_getaffinity(0)) + MORE_THAN_CORES
        self._waiting: list[tuple[float, int, asyncio.Future[None]]] = []
        self._number = itertools.count()
        self.scenarios = ScenariosAtWork()

    @asynccontextmanager
    async def slot(self, expected_s: float) -> AsyncIterator[Callable[[], None]]:
        """Wait for a slot; the start that is expected to take longest goes first.

        Gives what to call when the process is up; the slot is free then, or at the end of the block.
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
            self._give_soon(ITERATIONS)
        heapq.heappush(self._waiting, (-expected_s, next(self._number), turn))
        try:
            await turn
        except asyncio.CancelledError:
            if turn.done() and not turn.cancelled():  # it was given a slot at the same moment
                self._release()
            raise

    def _give_soon(self, iterations: int) -> None:
        if iterations:
            asyncio.get_running_loop().call_soon(self._give_soon, iterations - 1)
        else:
            self._give()

    def _give(self) -> None:
        while self._free and self._waiting:
            _, _, turn = heapq.heappop(self._waiting)
            if not turn.done():
                turn.set_result(None)
                self._free -= 1

    def _release(self) -> None:
        self._free += 1
        self._give()
