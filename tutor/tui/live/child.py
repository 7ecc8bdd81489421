"""The app's handle on the watcher process, whose crash does not affect the app."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import AsyncIterator
from pathlib import Path

from tutor.live.protocol import Update, WatcherRequest, decode_update, encode_request
from tutor.process.line_child import LineChild
from tutor.tui.live.launching import WatcherCommand

_STOP_TIMEOUT_S = 1.5
"""Grace period in seconds between closing the child's stdin and SIGKILL."""

_MAX_UNSENT_BYTES = 1 << 20


class LiveChild(LineChild):
    """One run of `python -m tutor.live`. It exits at the end of its stdin, and so whenever and however the app ends."""

    @classmethod
    async def start(cls, command: WatcherCommand) -> LiveChild:
        """Start the child outside of the learner's folder. Raises OSError.

        Call this on the app's main thread: the child is killed when the thread that started it ends.
        """
        return await cls._start(command.argv, Path("/"), env=command.env, stdin=asyncio.subprocess.PIPE)

    def send(self, request: WatcherRequest) -> None:
        """Send a request. Never blocks; requests to a dead or stuck child are dropped."""
        assert self._process.stdin is not None
        transport = self._process.stdin.transport
        if not transport.is_closing() and transport.get_write_buffer_size() < _MAX_UNSENT_BYTES:
            self._process.stdin.write(encode_request(request).encode() + b"\n")

    async def updates(self) -> AsyncIterator[Update]:
        """Yield the child's updates until it ends. Raises ValueError for a line that is not an update."""
        async for line in self.lines():
            yield decode_update(line)

    def detach(self) -> None:
        """Close the child's stdin, after which it soon exits on its own."""
        assert self._process.stdin is not None
        self._process.stdin.close()

    async def stop(self) -> None:
        """End the child, and wait until it is gone."""
        self.detach()
        try:
            await asyncio.wait_for(self._process.wait(), _STOP_TIMEOUT_S)
        except TimeoutError:
            self.kill()
            await self._process.wait()
        finally:
            self._reader.cancel()

    def kill(self) -> None:
        """Send SIGKILL, as the last resort."""
        self.send_signal(signal.SIGKILL)

    @property
    def last_error_line(self) -> str:
        """The last non-empty line that the child wrote to stderr."""
        return next((line for line in reversed(self.output_tail) if line.strip()), "")
