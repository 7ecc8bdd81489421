"""A Dask scheduler and its workers as processes on this machine."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tutor.interpreter import FLAGS
from tutor.process.orphans import command_line
from tutor.process.process_table import descendants

_WORKER = "from distributed.cli.dask_worker import main; main()"
_START_S = 300.0


class Processes:
    """A scheduler at `address`, and workers without a nanny: a killed one is not started again."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._log = (folder / "log").open("ab")
        self._started: list[subprocess.Popen[bytes]] = []
        file = folder / "scheduler.json"
        options = ("--scheduler-file", str(file), "--port=0", "--dashboard-address=127.0.0.1:0")
        self._start("-m", "distributed.cli.dask_scheduler", *options, *self._options())
        self.address = self._read_address(file)

    def worker(self, *options: str, before: str = "") -> int:
        """Start a worker with one thread and return its pid. `before`: Python code that it runs first."""
        words = [self.address, "--no-nanny", "--nthreads=1", f"--local-directory={self._folder}"]
        return self._start("-c", before + _WORKER, *words, *self._options(), *options)

    def kill(self, pid: int) -> None:
        """Kill a worker."""
        process = next(process for process in self._started if process.pid == pid)
        process.kill()
        process.wait()

    def close(self) -> None:
        for process in self._started:
            process.kill()
            process.wait()
        self._log.close()

    def _start(self, *words: str) -> int:
        argv = [sys.executable, *FLAGS, *words]
        self._started.append(subprocess.Popen(argv, cwd=self._folder, stdout=self._log, stderr=self._log))
        return self._started[-1].pid

    def _options(self) -> tuple[str, ...]:
        return "--host=127.0.0.1", "--no-dashboard"

    def _read_address(self, file: Path) -> str:
        import json

        until = time.monotonic() + _START_S
        while time.monotonic() < until:
            if file.exists() and (text := file.read_text()):
                return str(json.loads(text)["address"])
            time.sleep(0.05)
        raise TimeoutError((self._folder / "log").read_text())


@contextmanager
def processes(folder: Path) -> Iterator[Processes]:
    """Start a scheduler without workers; end it and them afterwards."""
    started = Processes(folder)
    try:
        yield started
    finally:
        started.close()


def is_checking(worker: int) -> bool:
    """Whether the process of a check is running below a worker."""
    return any("tutor.engine" in command_line(process.pid) for process in descendants(worker) if process.alive)


def family(worker: int) -> list[tuple[int, str]]:
    """Return the processes below a worker: their pid, and when they were started, since pids are used again."""
    return [(process.pid, _started_at(process.pid)) for process in descendants(worker) if process.alive]


def survivors(family: list[tuple[int, str]]) -> list[int]:
    """Return the pids of those that are still there."""
    return [pid for pid, started_at in family if started_at and _started_at(pid) == started_at]


def _started_at(pid: int) -> str:
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return ""
    return "" if fields[0] in "ZX" else fields[19]


def exists(pid: int) -> bool:
    """Whether there is such a process, not counting one that has ended and waits for its parent."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return bool(_started_at(pid))
