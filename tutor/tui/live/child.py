"""The watching process, as the app sees it: whatever happens there, the app lives on."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import AsyncIterator
from pathlib import Path

from tutor.live.protocol import Update, WatcherRequest, decode_update, encode_request
from tutor.process.line_child import LineChild
from tutor.tui.live.launching import WatcherCommand

END_S = 1.5
"""How long it may take to end once its input is closed; then it is killed."""

_MOST_UNSENT = 1 << 20


class LiveChild(LineChild):
    """One run of `python -m tutor.live`. It ends with its input, so with the app, however that ends."""

    @classmethod
    async def start(cls, command: WatcherCommand) -> LiveChild:
        """Start it, away from the learner's folder. Raises OSError.

        To be called on the app's own thread: the child is killed with the thread that started it.
        """
        return await cls._start(command.argv, Path("/"), env=command.env, stdin=asyncio.subprocess.PIPE)

    def send(self, request: WatcherRequest) -> None:
        """Have it do this. Never waits; what is sent to a dead or stuck child is lost."""
        assert self._process.stdin is not None
        transport = self._process.stdin.transport
        if not transport.is_closing() and transport.get_write_buffer_size() < _MOST_UNSENT:
            self._process.stdin.write(encode_request(request).encode() + b"\n")

    async def updates(self) -> AsyncIterator[Update]:
        """Its updates, until it ends. Raises ValueError for a line that is not an update."""
        async for line in self.lines():
            yield decode_update(line)

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
        self.send_signal(signal.SIGKILL)

    @property
    def last_error_line(self) -> str:
        """The last line that it wrote to stderr."""
        return next((line for line in reversed(self.output_tail) if line.strip()), "")
