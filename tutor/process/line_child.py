"""Runs one of our own programs as a child that prints lines: the app never imports rclpy, and survives a crash."""

from __future__ import annotations

import asyncio
import contextlib
import signal
from collections import deque
from collections.abc import AsyncIterator, Mapping, Sequence
from pathlib import Path
from typing import Self

_MAX_LINE_BYTES = 1 << 24
_STDERR_TAIL_LINES = 40


class LineChild:
    """A running child. Its stderr is drained in the background, so that it never blocks there; the tail is kept."""

    def __init__(self, process: asyncio.subprocess.Process) -> None:
        self._process = process
        self._stderr: deque[str] = deque(maxlen=_STDERR_TAIL_LINES)
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
        """Start the child in its own process group, out of reach of a Ctrl+C in the terminal. Raises OSError."""
        process = await asyncio.create_subprocess_exec(
            *argv,
            cwd=cwd,
            env=env,
            stdin=stdin,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.PIPE,
            limit=_MAX_LINE_BYTES,
            process_group=0,
        )
        return cls(process)

    @property
    def pid(self) -> int:
        """The child's process id."""
        return self._process.pid

    async def lines(self) -> AsyncIterator[str]:
        """Yield the non-blank lines that it prints, until it closes stdout."""
        assert self._process.stdout is not None
        async for line in self._process.stdout:
            if text := line.decode("utf-8", "replace").strip():
                yield text

    def send_signal(self, number: signal.Signals) -> None:
        """Send a signal if the child is still running."""
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
