"""Run a scenario alone, when a busy machine kept it from being judged while others were running."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager

POLL_S = 0.05
"""Poll interval of a scenario that waits for all others to end."""


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
                    await asyncio.sleep(POLL_S)
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
