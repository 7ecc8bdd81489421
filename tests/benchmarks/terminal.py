"""A program in its own terminal (a pty), and its resource use."""

from __future__ import annotations

import fcntl
import os
import pty
import re
import select
import signal
import struct
import termios
import time
from dataclasses import dataclass
from pathlib import Path

SIZE = (36, 120)
"""Rows and columns."""

LIMIT_S = 30.0

_ESCAPES = re.compile(rb"\x1b\[[0-9;?<>=]*[ -/]*[@-~]|\x1b[@-_]|\x1b\][^\x07]*\x07")
_ENTER_ALTERNATE_SCREEN = b"\x1b[?1049h"
_TICK = os.sysconf("SC_CLK_TCK")


class Terminal:
    """An app in a pty."""

    def __init__(self, argv: list[str], env: dict[str, str]) -> None:
        self.pid, self._fd = pty.fork()
        if self.pid == 0:
            os.execve(argv[0], argv, {**env, "TERM": "xterm-256color", "COLUMNS": "120", "LINES": "36"})
        fcntl.ioctl(self._fd, termios.TIOCSWINSZ, struct.pack("HHHH", *SIZE, 0, 0))
        self._seen = b""

    def press(self, key: bytes) -> None:
        self._seen = b""
        os.write(self._fd, key)

    def wait_for_text(self, text: bytes, limit_s: float = LIMIT_S, *, resumed: bool = False) -> float:
        """Read until this text has been drawn; return the time (`perf_counter`).

        With `resumed`, only text after the app took the terminal back counts: it had handed it over after the last key.
        """
        deadline = time.perf_counter() + limit_s
        while text not in _ESCAPES.sub(
            b"", self._seen.partition(_ENTER_ALTERNATE_SCREEN)[2] if resumed else self._seen
        ):
            left = deadline - time.perf_counter()
            if left <= 0:
                raise TimeoutError(f"{text!r} is not drawn: {_ESCAPES.sub(b'', self._seen)[-3000:]!r}")
            self.read(left)
        return time.perf_counter()

    def read(self, for_s: float) -> None:
        """Read once, waiting at most `for_s` seconds for output."""
        if select.select([self._fd], [], [], for_s)[0]:
            self._seen += os.read(self._fd, 1 << 16)

    def drain(self, for_s: float) -> None:
        """Read and discard output for this long."""
        deadline = time.perf_counter() + for_s
        while (left := deadline - time.perf_counter()) > 0:
            self.read(left)
            self._seen = b""

    def kill(self) -> None:
        """Send SIGKILL. The terminal itself stays open, as the learner's would; `detach` closes it."""
        os.kill(self.pid, signal.SIGKILL)
        os.waitpid(self.pid, 0)

    def detach(self) -> None:
        """Close the terminal."""
        if self._fd >= 0:
            os.close(self._fd)
        self._fd = -1

    def wait_for_exit(self, limit_s: float = LIMIT_S) -> bool:
        """Return whether the app exits on its own within that time; its output is read meanwhile."""
        deadline = time.perf_counter() + limit_s
        while time.perf_counter() < deadline:
            if os.waitpid(self.pid, os.WNOHANG)[0]:
                return True
            try:
                if self._fd >= 0:
                    self.read(0.02)
                    continue
            except OSError:  # the app has closed its end
                pass
            time.sleep(0.02)
        return False

    def close(self) -> None:
        """Quit the app and wait for its exit. Raises TimeoutError if it does not exit in time, after killing it."""
        self.press(b"\x11")
        try:
            if not self.wait_for_exit():
                self.kill()
                raise TimeoutError(f"it does not quit: {_ESCAPES.sub(b'', self._seen)[-3000:]!r}")
        finally:
            self.detach()


@dataclass(frozen=True, slots=True)
class Usage:
    """The resource use of a process so far: CPU seconds, and resident memory in MB."""

    cpu_s: float
    memory_mb: float


def cpu_wait_s(*pids: int) -> float:
    """Return for how many seconds the threads of these processes have been runnable without a free core."""
    tasks = [task for pid in pids for task in Path(f"/proc/{pid}/task").glob("*/schedstat")]
    return sum(int(task.read_text().split()[1]) for task in tasks) / 1e9


def read_usage(pid: int) -> Usage:
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return Usage((int(fields[11]) + int(fields[12])) / _TICK, pages * os.sysconf("SC_PAGE_SIZE") / 1e6)


def find_watcher(pid: int) -> int:
    """Return the pid of the app's watcher process."""
    return int(Path(f"/proc/{pid}/task/{pid}/children").read_text().split()[0])
