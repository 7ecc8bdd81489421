"""Reads a pipe on the event loop at a bounded cost, whatever is written to it."""

from __future__ import annotations

import asyncio
import contextlib
import fcntl
import os
import time
from collections.abc import Callable

PIPE_BYTES = 1 << 20

MAX_PER_S = 2_000_000
LINE_BYTES = 100
"""Sustained read rate of a pipe in bytes per second, with each line counted as `LINE_BYTES` extra: about 20,000 short
lines or 2 MB of long ones. A faster writer blocks, as it does on a slow terminal.

A node that logs as fast as rclpy can, some 10,000 lines per second, stays below this and is never slowed down. One that
prints in an endless loop sleeps most of the time. Otherwise ten runs of it, each printing with a full core, would keep
the machine too busy to judge any of them.
"""

BURST_BYTES = 5_000_000
"""Burst allowance after a quiet period, counted in the same way: a large table may be printed at once."""

_PAUSE_S = 0.01
"""Pause after each read, and so the latency of a line: tiny writes cost at most a hundred reads per second."""

_LONGEST_PAUSE_S = 0.5
_FLOOD_PIPE_BYTES = 1 << 16
_FLOOD_READ_BYTES = 20_000
"""Pipe and read size during a flood, small so that the output shown is not seconds old."""


class PipeReader:
    """Reads from one pipe and passes each chunk to `feed`, until all writers are gone or the reader is closed."""

    def __init__(self, feed: Callable[[bytes], None]) -> None:
        """Create the pipe. Pass its write end `writer` to a process, then call `close_writer`."""
        self._loop = asyncio.get_running_loop()
        self._feed = feed
        self._pause: asyncio.TimerHandle | None = None
        self._credit = float(BURST_BYTES)
        self._credit_at = time.monotonic()
        self._is_flood = False
        self._fd, self.writer = os.pipe()
        os.set_blocking(self._fd, False)
        # If this exceeds the per-user limit, the pipe stays smaller, which only slows down a flood.
        with contextlib.suppress(OSError):
            fcntl.fcntl(self._fd, fcntl.F_SETPIPE_SZ, PIPE_BYTES)
        self._capacity = fcntl.fcntl(self._fd, fcntl.F_GETPIPE_SZ)
        self.inode = os.fstat(self._fd).st_ino
        self._loop.add_reader(self._fd, self._on_readable)

    def close_writer(self) -> None:
        """Close our copy of the write end."""
        if self.writer >= 0:
            os.close(self.writer)
            self.writer = -1

    def drain(self) -> None:
        """Read what is in the pipe now, at most its capacity: a process that keeps writing cannot hold us up."""
        left = self._capacity
        while left > 0 and (count := self._read(PIPE_BYTES)):
            left -= count

    def catch_up(self) -> None:
        """Read what is in the pipe now, unless its writer is being throttled."""
        if self._delay_s() <= 0:
            self.drain()

    def close(self) -> None:
        """Stop reading. Idempotent."""
        self.close_writer()
        if self._pause is not None:
            self._pause.cancel()
        if self._fd >= 0:
            self._loop.remove_reader(self._fd)
            os.close(self._fd)
            self._fd = -1

    def _delay_s(self) -> float:
        """Return how many seconds to wait before the next read to hold the rate limit; 0 or less if none."""
        now = time.monotonic()
        self._credit = min(BURST_BYTES, self._credit + (now - self._credit_at) * MAX_PER_S)
        self._credit_at = now
        return -self._credit / MAX_PER_S

    def _read(self, max_bytes: int) -> int:
        if self._fd < 0:
            return 0
        try:
            data = os.read(self._fd, max_bytes)
        except BlockingIOError:
            return 0
        self._credit = max(self._credit - len(data) - LINE_BYTES * data.count(b"\n"), -_LONGEST_PAUSE_S * MAX_PER_S)
        if data:
            self._feed(data)
        else:
            self.close()
        return len(data)

    def _on_readable(self) -> None:
        if self._read(_FLOOD_READ_BYTES if self._is_flood else PIPE_BYTES) and self._fd >= 0:
            self._loop.remove_reader(self._fd)
            delay_s = self._delay_s()
            if delay_s > 0 and not self._is_flood:
                self._is_flood = True
                self.drain()
                with contextlib.suppress(OSError):  # the pipe has already been filled again
                    fcntl.fcntl(self._fd, fcntl.F_SETPIPE_SZ, _FLOOD_PIPE_BYTES)
                if self._fd < 0:  # end of file was reached while draining
                    return
            self._pause = self._loop.call_later(max(_PAUSE_S, delay_s), self._resume)

    def _resume(self) -> None:
        if self._fd < 0:
            return
        if (delay_s := self._delay_s()) > 0:  # `drain` was called meanwhile
            self._pause = self._loop.call_later(delay_s, self._resume)
        else:
            self._loop.add_reader(self._fd, self._on_readable)
