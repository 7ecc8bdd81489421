"""Reading a pipe on the event loop at a bounded cost, whatever is written to it."""

from __future__ import annotations

import asyncio
import contextlib
import fcntl
import os
import time
from collections.abc import Callable

PIPE_BYTES = 1 << 20

MOST_PER_S = 2_000_000
LINE_BYTES = 100
"""What is read of a pipe in the long run, in bytes per second, where each line counts for `LINE_BYTES` more: 20,000
short lines, or 2 MB in long ones. A writer that has more waits, as a slow terminal makes it wait.

A node that logs as fast as rclpy can, some 10,000 lines in a second, stays below and is never slowed. One that prints
without end sleeps most of the time: ten starts of it, each with a core's worth of printing, would keep the machine so
busy that nothing could be said of any.
"""

BURST_BYTES = 5_000_000
"""What may be read beyond that after a quiet time, counted in the same way: a large table may be printed at once."""

_PAUSE_S = 0.01
"""After each read a pipe is left alone: tiny writes cost a hundred reads a second at most. A line is seen this late."""

_LONGEST_PAUSE_S = 0.5
_FLOOD_PIPE_BYTES = 1 << 16
_FLOOD_READ_BYTES = 20_000
"""Of a flood, little waits in the pipe, and little is read at once, so that what is seen of it is not seconds old."""


class PipeReader:
    """Reads from one pipe and hands each chunk to `feed`, until all writers are gone or it is closed."""

    def __init__(self, feed: Callable[[bytes], None]) -> None:
        """Make the pipe. Its other end is `writer`, to be given to a process and then closed by `close_writer`."""
        self._loop = asyncio.get_running_loop()
        self._feed = feed
        self._pause: asyncio.TimerHandle | None = None
        self._credit = float(BURST_BYTES)
        self._credit_at = time.monotonic()
        self._is_flood = False
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
        while left > 0 and (count := self._read(PIPE_BYTES)):
            left -= count

    def catch_up(self) -> None:
        """Read what is in the pipe right now, unless its writer is being slowed."""
        if self._owed_s() <= 0:
            self.drain()

    def close(self) -> None:
        """Stop reading. May be called twice."""
        self.close_writer()
        if self._pause is not None:
            self._pause.cancel()
        if self._fd >= 0:
            self._loop.remove_reader(self._fd)
            os.close(self._fd)
            self._fd = -1

    def _owed_s(self) -> float:
        """How many seconds nothing is to be read, so that its writer is no faster than it may be; below 0: none."""
        now = time.monotonic()
        self._credit = min(BURST_BYTES, self._credit + (now - self._credit_at) * MOST_PER_S)
        self._credit_at = now
        return -self._credit / MOST_PER_S

    def _read(self, most: int) -> int:
        if self._fd < 0:
            return 0
        try:
            data = os.read(self._fd, most)
        except BlockingIOError:
            return 0
        self._credit = max(self._credit - len(data) - LINE_BYTES * data.count(b"\n"), -_LONGEST_PAUSE_S * MOST_PER_S)
        if data:
            self._feed(data)
        else:
            self.close()
        return len(data)

    def _on_readable(self) -> None:
        if self._read(_FLOOD_READ_BYTES if self._is_flood else PIPE_BYTES) and self._fd >= 0:
            self._loop.remove_reader(self._fd)
            owed_s = self._owed_s()
            if owed_s > 0 and not self._is_flood:
                self._is_flood = True
                self.drain()
                with contextlib.suppress(OSError):  # where it has been filled again already
                    fcntl.fcntl(self._fd, fcntl.F_SETPIPE_SZ, _FLOOD_PIPE_BYTES)
                if self._fd < 0:  # its end was drained
                    return
            self._pause = self._loop.call_later(max(_PAUSE_S, owed_s), self._resume)

    def _resume(self) -> None:
        if self._fd < 0:
            return
        if (owed_s := self._owed_s()) > 0:  # for what was drained meanwhile
            self._pause = self._loop.call_later(owed_s, self._resume)
        else:
            self._loop.add_reader(self._fd, self._on_readable)
