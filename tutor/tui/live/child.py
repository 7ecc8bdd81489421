"""The watching process, as the app sees it. The app never imports rclpy, and lives on whatever happens there."""

from __future__ import annotations

import asyncio
import contextlib
import signal
from collections import deque
from collections.abc import AsyncIterator
from pathlib import Path

from tutor.live.protocol import Update, WatcherRequest, decode_update, encode_request
from tutor.tui.live.launching import WatcherCommand

END_S = 1.5
"""How long it may take to end once its input is closed; then it is killed."""

_LONGEST_LINE = 1 << 24
_MOST_UNSENT = 1 << 20
_LAST_LINES = 20


class LiveChild:
    """One run of `python -m tutor.live`. It ends with its input, so with the app, however that ends."""

    def __init__(self, process: asyncio.subprocess.Process) -> None:
        self._process = process
        self._stderr: deque[str] = deque(maxlen=_LAST_LINES)
        self._reader = asyncio.create_task(self._read_stderr())

    @classmethod
    async def start(cls, command: WatcherCommand) -> LiveChild:
        """Start it, in a process group of its own and away from the learner's folder. Raises OSError.

        To be called on the app's own thread: the child is killed with the thread that started it.
        """
        pipe = asyncio.subprocess.PIPE
        process = await asyncio.create_subprocess_exec(
            *command.argv,
            env=dict(command.env),
            cwd=Path("/"),
            stdin=pipe,
            stdout=pipe,
            stderr=pipe,
            limit=_LONGEST_LINE,
            process_group=0,
        )
        return cls(process)

    @property
    def pid(self) -> int:
        """Its process id."""
        return self._process.pid

    def send(self, command: WatcherRequest) -> None:
        """Have it do this. Never waits; what a dead or stuck child is told is lost."""
        assert self._process.stdin is not None
        transport = self._process.stdin.transport
        if not transport.is_closing() and transport.get_write_buffer_size() < _MOST_UNSENT:
            self._process.stdin.write(encode_request(command).encode() + b"\n")

    async def updates(self) -> AsyncIterator[Update]:
        """What it tells, until it ends. Raises ValueError for a line that is not an update."""
        assert self._process.stdout is not None
        async for line in self._process.stdout:
            if text := line.decode("utf-8", "replace").strip():
                yield decode_update(text)

    def detach(self) -> None:
        """Close its input: it ends soon, by itself."""
        assert self._process.stdin is not None
        self._process.stdin.close()

    async def stop(self) -> None:
        """End it, and wait until it is gone."""
        self.detach()
        try:
            await asyncio.wait_for(self._process.wait(), END_S)
        except TimeoutError:
            self.kill()
            await self._process.wait()
        finally:
            self._reader.cancel()

    def kill(self) -> None:
        """The last resort."""
        if self._process.returncode is None:
            with contextlib.suppress(ProcessLookupError):
                self._process.send_signal(signal.SIGKILL)

    @property
    def output_tail(self) -> str:
        """The last line that it wrote to stderr."""
        return next((line for line in reversed(self._stderr) if line.strip()), "")

    async def _read_stderr(self) -> None:
        assert self._process.stderr is not None
        async for line in self._process.stderr:
            self._stderr.append(line.decode("utf-8", "replace").rstrip())
