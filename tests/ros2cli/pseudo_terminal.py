"""A program on a pseudo-terminal of its own, at which a test types."""

from __future__ import annotations

import os
import pty
import select
import signal
import subprocess
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

LIMIT_S = 60.0


class Terminal:
    """A program and its terminal. `seen` is the output after the last match of `until`."""

    def __init__(self, master: int, process: subprocess.Popen[bytes]) -> None:
        self._master = master
        self.process = process
        self.seen = ""

    def type(self, text: str) -> None:
        """Press these keys."""
        os.write(self._master, text.encode())

    def until(self, text: str) -> str:
        """Wait until the program prints `text`. Return the output up to and including it."""
        deadline = time.monotonic() + LIMIT_S
        while text not in self.seen:
            left = deadline - time.monotonic()
            assert left > 0, f"{text!r} is not in {self.seen!r}"
            if select.select([self._master], [], [], left)[0]:
                try:
                    self.seen += os.read(self._master, 65536).decode(errors="replace")
                except OSError:  # the program has ended
                    assert text in self.seen, f"{text!r} is not in {self.seen!r}"
        before, found, self.seen = self.seen.partition(text)
        return before + found

    def end(self) -> int:
        """Wait for the program to exit. Return its exit code."""
        return self.process.wait(LIMIT_S)


@contextmanager
def terminal(command: list[str], env: Mapping[str, str], cwd: Path) -> Iterator[Terminal]:
    """Run a program on a terminal, which hangs up after the block; the program is killed if it does not exit then."""
    master, slave = pty.openpty()
    process = subprocess.Popen(
        ["setsid", "--ctty", "--wait", *command], env=env, cwd=cwd, stdin=slave, stdout=slave, stderr=slave
    )
    os.close(slave)
    try:
        yield Terminal(master, process)
    finally:
        with suppress(OSError):
            os.close(master)  # the terminal hangs up
        with suppress(subprocess.TimeoutExpired):
            process.wait(5)
        with suppress(ProcessLookupError):
            process.send_signal(signal.SIGKILL)
        process.wait()
