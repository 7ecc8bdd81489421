"""Runs `ros-tutor grade` as a process of its own, watches it, kills it, and finds what it leaves behind."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Sequence
from pathlib import Path

from tutor.process.process_table import descendants, processes

ROOT = Path(__file__).parents[2]
GONE_S = 30.0
"""How long the processes of a killed run may take to end, in seconds."""


class GradeProcess:
    """A running `ros-tutor grade`. `temporary`: its folder for temporary files, by which what is left is recognised.

    `peak_mb`: the most memory that all its processes had together, shared memory counted once (PSS) where that can be
    read. `seen`: all processes that were ever there when it was looked at, each with when it was started.
    """

    def __init__(self, words: Sequence[str | Path], temporary: Path, *, look_every_s: float = 0.5) -> None:
        temporary.mkdir(parents=True, exist_ok=True)
        self.temporary = temporary
        self.peak_mb = 0.0
        self.seen: dict[int, str] = {}
        self.out = temporary.with_name(f"{temporary.name}.out")
        self.err = temporary.with_name(f"{temporary.name}.err")
        with self.out.open("wb") as out, self.err.open("wb") as err:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "tutor", "grade", *map(str, words)],
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=err,
                cwd=ROOT,
                env={**os.environ, "TMPDIR": str(temporary)},
            )
        self._ended = threading.Event()
        self._looking = threading.Thread(target=self._look, args=(look_every_s,), daemon=True)
        self._looking.start()

    def wait(self, limit_s: float | None = None) -> int:
        """Wait for its end; return its exit code. Raises TimeoutExpired."""
        code = self.process.wait(limit_s)
        self._ended.set()
        self._looking.join()
        return code

    def kill(self) -> float:
        """Kill `grade` alone; return how long its other processes took to end, in seconds. Raises AssertionError."""
        self.look()
        self.process.send_signal(signal.SIGKILL)
        self.wait()
        killed = time.monotonic()
        while left := self.left_running():
            assert time.monotonic() < killed + GONE_S, f"still running: {left}"
            time.sleep(0.05)
        return time.monotonic() - killed

    def left_running(self) -> list[str]:
        """Return the command lines of its processes that are running, apart from `grade` itself."""
        mark = os.fsencode(self.temporary)
        found = []
        for pid, process in processes().items():
            if pid == self.process.pid or not process.alive or pid == os.getpid():
                continue
            ours = self.seen.get(pid) == _started(pid)
            if ours or mark in _read(pid, "cmdline") or mark in _read(pid, "environ"):
                found.append(_read(pid, "cmdline").replace(b"\0", b" ").decode(errors="replace") or f"process {pid}")
        return found

    def left_files(self) -> list[str]:
        """Return what is left in its folder for temporary files; the logs of nodes may be."""
        own = self.temporary / f"ros-tutor-{os.getuid()}"
        inside = list(own.iterdir()) if own.exists() else []
        left = [*(path for path in self.temporary.iterdir() if path != own), *(p for p in inside if p.name != "log")]
        return [str(path.relative_to(self.temporary)) for path in left]

    def _look(self, every_s: float) -> None:
        while not self._ended.wait(every_s):
            self.look()

    def look(self) -> None:
        """Note which processes there are, and how much memory they have."""
        pids = [self.process.pid, *(process.pid for process in descendants(self.process.pid))]
        self.peak_mb = max(self.peak_mb, sum(_memory_kb(pid) for pid in pids) / 1024)
        for pid in pids:
            if started := _started(pid):
                self.seen[pid] = started


def _memory_kb(pid: int) -> int:
    for line in _read(pid, "smaps_rollup").splitlines():
        if line.startswith(b"Pss:"):
            return int(line.split()[1])
    fields = _read(pid, "statm").split()
    return int(fields[1]) * os.sysconf("SC_PAGESIZE") // 1024 if len(fields) > 1 else 0


def _started(pid: int) -> str:
    """Return when a process was started, by which it is told from a later one with its number; "" if it is gone."""
    fields = _read(pid, "stat").rpartition(b")")[2].split()
    return fields[19].decode() if len(fields) > 19 else ""


def _read(pid: int, name: str) -> bytes:
    with contextlib.suppress(OSError):
        return Path(f"/proc/{pid}/{name}").read_bytes()
    return b""
