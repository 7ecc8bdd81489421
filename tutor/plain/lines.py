"""What the learner types, line by line, for an event loop."""

from __future__ import annotations

import asyncio
import os
import sys
import threading


class Lines:
    """The lines of a terminal, a pipe or a file, each as soon as it is there."""

    def __init__(self, source: int | None) -> None:
        """`source` is a file descriptor; None is one that is closed."""
        self._source = source
        self._loop = asyncio.get_running_loop()
        self._queue: asyncio.Queue[str | None] = asyncio.Queue()
        # A thread, since a file on the disk cannot be waited for otherwise; a daemon, since nobody can end its waiting.
        threading.Thread(target=self._read, name="lines", daemon=True).start()

    @classmethod
    def of_stdin(cls) -> Lines:
        """Those of standard input."""
        try:
            return cls(None if sys.stdin is None else sys.stdin.fileno())
        except (OSError, ValueError):
            return cls(None)

    async def next(self) -> str | None:
        """The next line, without its end; None when there will be no more."""
        line = await self._queue.get()
        if line is None:
            self._queue.put_nowait(None)
        return line

    def _read(self) -> None:
        rest = b""
        while data := self._more():
            *whole, rest = (rest + data).split(b"\n")
            for line in whole:
                self._put(line)
        if rest:
            self._put(rest)
        self._tell(None)

    def _more(self) -> bytes:
        # Not by sys.stdin: its lock would be held by this thread when the interpreter ends.
        try:
            return b"" if self._source is None else os.read(self._source, 65536)
        except OSError:  # the terminal is gone
            return b""

    def _put(self, line: bytes) -> None:
        self._tell(line.decode("utf-8", "replace").rstrip("\r"))

    def _tell(self, line: str | None) -> None:
        try:
            self._loop.call_soon_threadsafe(self._queue.put_nowait, line)
        except RuntimeError:  # the loop is closed: nobody listens any more
            return
