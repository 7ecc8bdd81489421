"""The learner's input, line by line, for an event loop."""

from __future__ import annotations

import asyncio
import os
import sys
import threading


class LineReader:
    """Reads lines from a terminal, a pipe or a file, each as soon as it arrives."""

    def __init__(self, source: int | None) -> None:
        """`source` is a file descriptor, or None if it is closed."""
        self._source = source
        self._loop = asyncio.get_running_loop()
        self._queue: asyncio.Queue[str | None] = asyncio.Queue()
        # A thread, since an event loop cannot wait for regular files; a daemon, since nothing can interrupt its read.
        threading.Thread(target=self._read, name="lines", daemon=True).start()

    @classmethod
    def from_stdin(cls) -> LineReader:
        """Return a reader of standard input."""
        try:
            return cls(None if sys.stdin is None else sys.stdin.fileno())
        except (OSError, ValueError):
            return cls(None)

    async def next(self) -> str | None:
        """Return the next line without its line ending; None at the end of input."""
        line = await self._queue.get()
        if line is None:
            self._queue.put_nowait(None)
        return line

    def _read(self) -> None:
        rest = b""
        while chunk := self._read_chunk():
            *lines, rest = (rest + chunk).split(b"\n")
            for line in lines:
                self._put_line(line)
        if rest:
            self._put_line(rest)
        self._put_threadsafe(None)

    def _read_chunk(self) -> bytes:
        # Not from sys.stdin: this thread would hold its lock when the interpreter exits.
        try:
            return b"" if self._source is None else os.read(self._source, 65536)
        except OSError:  # the terminal is gone
            return b""

    def _put_line(self, line: bytes) -> None:
        self._put_threadsafe(line.decode("utf-8", "replace").rstrip("\r"))

    def _put_threadsafe(self, line: str | None) -> None:
        try:
            self._loop.call_soon_threadsafe(self._queue.put_nowait, line)
        except RuntimeError:  # the loop is closed: nobody reads any more
            return
