"""The engine as a child process, so that a crash of the engine does not affect the app."""

from __future__ import annotations

import asyncio
import json
import signal
from collections.abc import AsyncIterator, Sequence
from pathlib import Path

from tutor.judge.events import Event, decode
from tutor.process import orphans, prctl
from tutor.process.line_child import LineChild

CLEAN_UP_S = 10.0
"""Timeout for a cancelled check to end the learner's processes, in seconds."""


class EngineChild(LineChild):
    """One run of the engine, which prints one event per line."""

    @classmethod
    async def start(cls, argv: Sequence[str], cwd: Path, *, standby: bool = False) -> EngineChild:
        """Start the engine; `standby`: it reads its arguments from stdin (see `give_arguments`). Raises OSError."""
        prctl.guard()
        prctl.adopt_orphans(True)
        return await cls._start(argv, cwd, stdin=asyncio.subprocess.PIPE if standby else asyncio.subprocess.DEVNULL)

    @property
    def running(self) -> bool:
        """Whether it has not exited yet, as far as is known."""
        return self._process.returncode is None

    def give_arguments(self, arguments: Sequence[str]) -> None:
        """Give an engine on standby its arguments. If it has just exited, they are lost."""
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps(arguments).encode() + b"\n")

    async def events(self) -> AsyncIterator[Event]:
        """Yield events as they arrive, until the child closes its output.

        Raises ValueError for a line that is not an event.
        """
        async for line in self.lines():
            yield decode(line)

    async def ended(self) -> int:
        """Wait for the child to exit; return its exit code, negative for a signal."""
        code = await self._process.wait()
        await self._reader
        return code

    async def stop(self, limit_s: float = CLEAN_UP_S) -> None:
        """Interrupt the child and wait until it has cleaned up; kill it if that takes longer than `limit_s`."""
        for signum in (signal.SIGINT, signal.SIGKILL):
            if self._process.returncode is None:
                self.send_signal(signum)
                try:
                    await asyncio.wait_for(self._process.wait(), limit_s)
                except TimeoutError:
                    continue
        self._reader.cancel()
        if self._process.returncode is not None and self._process.returncode < 0:
            orphans.end_orphans()  # it was killed and could not clean up
