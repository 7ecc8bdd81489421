"""Starts engines for the checks of the app, and keeps one ready for the next."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from pathlib import Path

from tutor.session.engine_child import EngineChild

KEEP_READY_S = 300.0
"""How long an engine is kept ready: it takes memory."""


class EngineStarter:
    """Starts engines with `command(*arguments)`. One that is kept ready begins its check most of a second sooner."""

    def __init__(self, command: Callable[..., Sequence[str]]) -> None:
        self._command = command
        self._ready: EngineChild | None = None
        self._cwd: Path | None = None
        self._over: asyncio.Event | None = None

    @property
    def keeps_one(self) -> bool:
        """Whether `keep_ready` is running."""
        return self._over is not None

    async def start(self, arguments: Sequence[str], cwd: Path) -> EngineChild:
        """Start an engine with these arguments, or use the one that is ready. Raises OSError."""
        self.release()
        ready = self._ready
        if ready is None or not ready.running or cwd != self._cwd:
            return await EngineChild.start(self._command(*arguments), cwd)
        self._ready = None  # before `keep_ready` ends it
        ready.give_arguments(arguments)
        return ready

    async def keep_ready(self, cwd: Path) -> None:
        """Start an engine, and keep it until it is used, `release` is called, or `KEEP_READY_S` have passed.

        Does nothing if one is kept already.
        """
        if self.keeps_one:
            return
        self._over = over = asyncio.Event()
        self._cwd = cwd
        try:
            self._ready = await EngineChild.start(self._command("--standby"), cwd, standby=True)
            await asyncio.wait_for(over.wait(), KEEP_READY_S)
        except (OSError, TimeoutError):
            pass  # the next check reports what is wrong
        finally:
            unused, self._ready, self._over = self._ready, None, None
            if unused is not None:
                await unused.stop()

    def release(self) -> None:
        """End `keep_ready`, and with it the engine that was not used."""
        if self._over is not None:
            self._over.set()
