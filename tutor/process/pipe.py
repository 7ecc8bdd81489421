"""Reading a pipe on the event loop at a bounded cost, whatever is written to it."""

from __future__ import annotations

import asyncio
import contextlib
import fcntl
import os
import time
from collections.abc import Callable

PIPE_BYTES = 1 << 20
# After each read the pipe is left alone for a while, and its writer waits when it is full. So a flood of tiny writes
# costs a hundred reads a second at most, and a flood of big ones a twentieth of our time: the pause is as many times
# as long as the read took. A line is seen this much late.
_PAUSE_S = 0.01
_LONGEST_PAUSE_S = 0.1
_PAUSE_FOR_READ = 20


class PipeReader:
    """Reads from one pipe and hands each chunk to `feed`, until all writers are gone or it is closed."""

    def __init__(self, feed: Callable[[bytes], None]) -> None:
        """Make the pipe. Its other end is `writer`, to be given to a process and then closed by `close_writer`."""
        self._loop = asyncio.get_running_loop()
        self._feed = feed
        self._pause: asyncio.TimerHandle | None = None
        self._fd, self.writer = os.pipe()
        os.set_blocking(self._fd, False)
        # Where this is beyond what the system allows one user, a smaller pipe only makes a flood slower.
        with contextlib.suppress(OSError):
            fcntl.fcntl(self._fd, fcntl.F_SETPIPE_SZ, PIPE_BYTES)
        self._capacity = fcntl.fcntl(self._fd, fcntl.F_GETPIPE_SZ)
        self.inode = os.fstat(self._fd).st_ino
        self._loop.add_reader(self._fd, self._on_readable)

    def close_writer(self) -> None:
        """Close our copy of the writers' end."""
        if self.writer >= 0:
            os.close(self.writer)
            self.writer = -1

    def drain(self) -> None:
        """Read what is in the pipe right now, and no more: a process that goes on writing holds nothing up."""
        left = self._capacity
        while left > 0 and (count := self._read()):
            left -= count

    def close(self) -> None:
        """Stop reading. May be called twice."""
        self.close_writer()
        if self._pause is not None:
            self._pause.cancel()
        if self._fd >= 0:
            self._loop.remove_reader(self._fd)
            os.close(self._fd)
            self._fd = -1

    def _read(self) -> int:
        if self._fd < 0:
            return 0
        try:
            data = os.read(self._fd, PIPE_BYTES)
        except BlockingIOError:
            return 0
        if data:
            self._feed(data)
        else:
            self.close()
        return len(data)

    def _on_readable(self) -> None:
        start = time.perf_counter()
        if self._read():
            took = time.perf_counter() - start
            self._loop.remove_reader(self._fd)
            pause = min(max(_PAUSE_S, _PAUSE_FOR_READ * took), _LONGEST_PAUSE_S)
            self._pause = self._loop.call_later(pause, self._resume)

    def _resume(self) -> None:
        if self._fd >= 0:
            self._loop.add_reader(self._fd, self._on_readable)
