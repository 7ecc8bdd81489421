"""Helpers for tests with real processes: scripts in a folder of their own, and the pids that they write down."""

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
from tutor.process.supervisor import processes

ROOT = Path(__file__).parents[2]
LIMIT_S = 20.0

# What the learners' scripts share: `note(name)` writes down a process's pid, whole or not at all.
_PRELUDE = """
import os, signal, sys, time
def note(name):
    with open(name + '.new', 'w') as file:
        file.write(str(os.getpid()))
    os.rename(name + '.new', name)
def forever():
    while True:
        time.sleep(1000)
"""


class Bench:
    """Starts learners' processes from source text and looks at what they leave."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.token = uuid.uuid4().hex
        self.env = {"PATH": os.environ["PATH"], "TEST_TOKEN": self.token}
        self.started: list[LearnerProcess] = []
        self.noted: set[int] = set()

    def script(self, source: str, *, flags: tuple[str, ...] = ("-I", "-S")) -> list[str]:
        """A command that runs `source` in Python."""
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
        """The environment of a process that uses tutor.process as we do."""
        return {**self.env, "PYTHONPATH": str(ROOT), "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1"}

    def helper(self, source: str, *, before: str = "pass", then: str = "pass") -> list[str]:
        """A command that starts `source` as we do, does `before` and `then` around that, and waits forever."""
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

    async def until(self, true: Callable[[], object], what: str) -> None:
        """Wait until `true` is."""
        await until(true, what)

    async def noted_pid(self, name: str) -> int:
        """The pid that a script wrote down as `name`."""
        file = self.folder / name
        await until(file.exists, f"{name} has started")
        pid = int(file.read_text())
        self.noted.add(pid)
        return pid

    def left(self) -> list[int]:
        """The living processes of this test: by their environment, and by the pids that they wrote down."""
        mark = f"TEST_TOKEN={self.token}".encode()
        return sorted(pid for pid, p in processes().items() if p.alive and (pid in self.noted or mark in _environ(pid)))

    async def all_gone(self) -> None:
        """Wait until none is left."""
        await until(lambda: not self.left(), f"all processes to be gone: {self.left()}")


def _environ(pid: int) -> list[bytes]:
    try:
        return Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
    except OSError:
        return []


async def until(true: Callable[[], object], what: str, limit_s: float = LIMIT_S) -> None:
    """Wait until `true` is, and fail with `what` if it never is."""
    end = time.monotonic() + limit_s
    while not true():
        assert time.monotonic() < end, f"waited {limit_s} s in vain for: {what}"
        await asyncio.sleep(0.002)


@pytest.fixture
async def bench(tmp_path: Path) -> AsyncIterator[Bench]:
    """A bench; after the test nothing may be left, and no descriptor of ours either."""
    before = len(os.listdir("/proc/self/fd"))
    bench = Bench(tmp_path)
    yield bench
    try:
        for learner in bench.started:
            await learner.end()
    finally:
        left = bench.left()
        for pid in left:
            os.kill(pid, signal.SIGKILL)
    assert not left
    assert len(os.listdir("/proc/self/fd")) <= before


@pytest.fixture
def bench_sync(tmp_path: Path) -> Bench:
    """A bench for a test that has an event loop of its own."""
    return Bench(tmp_path)
