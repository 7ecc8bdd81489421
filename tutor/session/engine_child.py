"""A check as a child process: the app never imports rclpy, and whatever happens to a check, the app lives on."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
from collections import deque
from collections.abc import AsyncIterator, Sequence
from pathlib import Path

from tutor.judge.events import Event, decode
from tutor.process import orphans, prctl

CLEAN_UP_S = 10.0
"""How long a cancelled check may take to end the learner's processes, in seconds."""

_LONGEST_LINE = 1 << 24
_LAST_LINES = 40


class EngineChild:
    """One run of the engine, which prints its events line by line."""

    def __init__(self, process: asyncio.subprocess.Process) -> None:
        self._process = process
        self._stderr: deque[str] = deque(maxlen=_LAST_LINES)
        self._reader = asyncio.create_task(self._read_stderr())

    @classmethod
    async def start(cls, argv: Sequence[str], cwd: Path) -> EngineChild:
        """Start it in a process group of its own, so that no Ctrl+C in an editor hits it. Raises OSError."""
        prctl.guard()
        prctl.adopt_orphans(True)
        pipe = asyncio.subprocess.PIPE
        process = await asyncio.create_subprocess_exec(
            *argv,
            cwd=cwd,
            stdin=asyncio.subprocess.DEVNULL,
            stdout=pipe,
            stderr=pipe,
            limit=_LONGEST_LINE,
            process_group=0,
        )
        return cls(process)

    async def events(self) -> AsyncIterator[Event]:
        """The events as they come, until the child closes its output.

        Raises ValueError for a line that is not an event.
        """
        assert self._process.stdout is not None
        async for line in self._process.stdout:
            if text := line.decode("utf-8", "replace").strip():
                yield decode(text)

    async def ended(self) -> int:
        """Wait for its end; the exit code, negative for a signal."""
        code = await self._process.wait()
        await self._reader
        return code

    async def stop(self, limit_s: float = CLEAN_UP_S) -> None:
        """Interrupt it and wait until it has cleaned up; kill it where that takes longer than the limit."""
        for number in (signal.SIGINT, signal.SIGKILL):
            if self._process.returncode is None:
                self._send(number)
                try:
                    await asyncio.wait_for(self._process.wait(), limit_s)
                except TimeoutError:
                    continue
        self._reader.cancel()
        if self._process.returncode is not None and self._process.returncode < 0:
            orphans.end_orphans()  # it was killed, and could not clean up

    @property
    def output_tail(self) -> tuple[str, ...]:
        """The last lines it wrote to stderr."""
        return tuple(self._stderr)

    def _send(self, number: signal.Signals) -> None:
        with contextlib.suppress(ProcessLookupError):
            os.kill(self._process.pid, number)

    async def _read_stderr(self) -> None:
        assert self._process.stderr is not None
        async for line in self._process.stderr:
            self._stderr.append(line.decode("utf-8", "replace").rstrip())
