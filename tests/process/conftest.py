"""Fixtures for tests with real processes: learners' scripts in a temporary folder, and the pids that they record."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
import time
import uuid
from collections.abc import AsyncIterator, Callable
from pathlib import Path

import pytest

from tutor.process import LearnerProcess
from tutor.process.process_table import processes

ROOT = Path(__file__).parents[2]
LIMIT_S = 20.0

# Prepended to the learners' scripts: `note(name)` atomically writes the process's pid to the file `name`.
_PRELUDE = """
import os, signal, sys, time
def note(name):
    with open(name + '.new', 'w') as file:
        file.write(str(os.getpid()))
    os.rename(name + '.new', name)
def forever():
    while True:  # a signal that comes just before a sleep is only handled after it
        time.sleep(0.1)
"""


class Bench:
    """Starts learners' processes from source text and tracks what they leave behind."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.token = uuid.uuid4().hex
        self.env = {"PATH": os.environ["PATH"], "TEST_TOKEN": self.token}
        self.started: list[LearnerProcess] = []
        self.noted_pids: set[int] = set()

    def script(self, source: str, *, flags: tuple[str, ...] = ("-I", "-S")) -> list[str]:
        """Return a command that runs `source` in Python."""
        file = self.folder / f"learner_{uuid.uuid4().hex[:8]}.py"
        file.write_text(_PRELUDE + source)
        return [sys.executable, *flags, str(file)]

    async def start(
        self, source: str, *, terminal: bool = False, on_change: Callable[[], None] | None = None
    ) -> LearnerProcess:
        """Start `source` as a learner's process."""
        learner = await LearnerProcess.start(
            self.script(source), env=self.env, cwd=self.folder, terminal=terminal, on_change=on_change
        )
        self.started.append(learner)
        return learner

    @property
    def helper_env(self) -> dict[str, str]:
        """The environment of a helper process that uses tutor.process as this one does."""
        return {**self.env, "PYTHONPATH": str(ROOT), "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1"}

    def helper(self, source: str, *, before: str = "pass", then: str = "pass") -> list[str]:
        """Return a command that runs `before`, starts `source` as this process does, runs `then`, and waits forever."""
        return self.script(
            f"""
import asyncio
from pathlib import Path
from tutor.process import LearnerProcess
async def main():
    learner = await LearnerProcess.start({self.script(source)!r}, env={self.env!r}, cwd=Path('.'))
    exec({then!r})
    await learner.wait(None)
exec({before!r})
asyncio.run(main())
""",
            flags=(),
        )

    async def until(self, condition: Callable[[], object], what: str) -> None:
        """Wait until `condition()` is true."""
        await until(condition, what)

    async def noted_pid(self, name: str) -> int:
        """Wait for the pid that a script notes as `name`, and return it."""
        file = self.folder / name
        await until(file.exists, f"{name} has started")
        pid = int(file.read_text())
        self.noted_pids.add(pid)
        return pid

    def leftovers(self) -> list[int]:
        """Return the pids of this test's living processes, found by their environment and by the pids they noted."""
        mark = f"TEST_TOKEN={self.token}".encode()
        return sorted(
            pid for pid, p in processes().items() if p.alive and (pid in self.noted_pids or mark in _environ(pid))
        )

    async def all_gone(self) -> None:
        """Wait until no process of this test is left."""
        await until(lambda: not self.leftovers(), f"all processes to be gone: {self.leftovers()}")


def _environ(pid: int) -> list[bytes]:
    try:
        return Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
    except OSError:
        return []


async def until(condition: Callable[[], object], what: str, limit_s: float = LIMIT_S) -> None:
    """Wait until `condition()` is true, and fail with `what` if it does not become true in time."""
    deadline = time.monotonic() + limit_s
    while not condition():
        assert time.monotonic() < deadline, f"waited {limit_s} s in vain for: {what}"
        await asyncio.sleep(0.002)


@pytest.fixture
async def bench(tmp_path: Path) -> AsyncIterator[Bench]:
    """A bench; after the test no process may be left, and no more file descriptors open than before."""
    before = len(os.listdir("/proc/self/fd"))
    bench = Bench(tmp_path)
    yield bench
    try:
        for learner in bench.started:
            await learner.end()
    finally:
        leftovers = bench.leftovers()
        for pid in leftovers:
            os.kill(pid, signal.SIGKILL)
    assert not leftovers
    assert len(os.listdir("/proc/self/fd")) <= before


@pytest.fixture
def bench_sync(tmp_path: Path) -> Bench:
    """A bench for a test that runs its own event loop."""
    return Bench(tmp_path)
