"""One of our programs as a child process that speaks in lines. The app never imports rclpy, and outlives the child."""

from __future__ import annotations

import asyncio
import contextlib
import signal
from collections import deque
from collections.abc import AsyncIterator, Mapping, Sequence
from pathlib import Path
from typing import Self

_LONGEST_LINE = 1 << 24
_LAST_LINES = 40


class LineChild:
    """One run of such a program. What it writes to stderr is kept in part, and never waited for."""

    def __init__(self, process: asyncio.subprocess.Process) -> None:
        self._process = process
        self._stderr: deque[str] = deque(maxlen=_LAST_LINES)
        self._reader = asyncio.create_task(self._read_stderr())

    @classmethod
    async def _start(
        cls,
        argv: Sequence[str],
        cwd: Path,
        *,
        env: Mapping[str, str] | None = None,
        stdin: int = asyncio.subprocess.DEVNULL,
    ) -> Self:
        """Start it in a process group of its own, so that no Ctrl+C in an editor hits it. Raises OSError."""
        process = await asyncio.create_subprocess_exec(
            *argv,
            cwd=cwd,
            env=env,
            stdin=stdin,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.PIPE,
            limit=_LONGEST_LINE,
            process_group=0,
        )
        return cls(process)

    @property
    def pid(self) -> int:
        """Its process id."""
        return self._process.pid

    async def lines(self) -> AsyncIterator[str]:
        """The lines that it prints, without empty ones, until it closes its output."""
        assert self._process.stdout is not None
        async for line in self._process.stdout:
            if text := line.decode("utf-8", "replace").strip():
                yield text

    def send_signal(self, number: signal.Signals) -> None:
        """Send it a signal, where it still runs."""
        if self._process.returncode is None:
            with contextlib.suppress(ProcessLookupError):
                self._process.send_signal(number)

    @property
    def output_tail(self) -> tuple[str, ...]:
        """The last lines it wrote to stderr."""
        return tuple(self._stderr)

    async def _read_stderr(self) -> None:
        assert self._process.stderr is not None
        async for line in self._process.stderr:
            self._stderr.append(line.decode("utf-8", "replace").rstrip())
