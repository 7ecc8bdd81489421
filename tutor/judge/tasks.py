"""Tasks that end with the block that started them."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine
from typing import Any, Self


class Tasks:
    """Starts tasks; those that are still under way when its context exits are cancelled."""

    def __init__(self) -> None:
        self._started: list[asyncio.Task[Any]] = []

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *_: object) -> None:
        for task in self._started:
            task.cancel()
        await asyncio.gather(*self._started, return_exceptions=True)

    def start[T](self, work: Coroutine[Any, Any, T]) -> asyncio.Task[T]:
        """Start a task."""
        task = asyncio.create_task(work)
        self._started.append(task)
        return task

    def count_done(self) -> int:
        """How many of the tasks have ended."""
        return sum(task.done() for task in self._started)
