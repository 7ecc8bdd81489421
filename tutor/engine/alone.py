"""Repeating a scenario alone: what could not be judged while others were at work may be, once they have ended."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager

LOOK_EVERY_S = 0.05


class ScenariosAtWork:
    """How many scenarios are at work: one that is to be alone waits for all others."""

    def __init__(self) -> None:
        self._count = 0
        self._next = asyncio.Lock()

    @asynccontextmanager
    async def at_work(self, *, alone: bool = False) -> AsyncIterator[None]:
        """A scenario is at work; `alone`: as soon as no other is."""
        if alone:
            async with self._next:
                while self._count:
                    await asyncio.sleep(LOOK_EVERY_S)
                self._count += 1
        else:
            self._count += 1
        try:
            yield
        finally:
            self._count -= 1

    @contextmanager
    def waiting(self) -> Iterator[None]:
        """A scenario at work waits for another one, which may have to be alone."""
        self._count -= 1
        try:
            yield
        finally:
            self._count += 1
