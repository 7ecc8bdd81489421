"""When a run takes too much of the machine."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tutor.process import LearnerProcess, run_limits
from tutor.process.run_limits import excess_of

ALLOCATES = "x = b'1' * (200 << 20); print('ready', flush=True); input()"
FORKS = """
import os, signal
shared = b"1" * (200 << 20)
for _ in range(3):
    if os.fork() == 0:
        signal.pause()
print("ready", flush=True)
input()
"""
STARTS_THREADS = """
import threading, time
threading.stack_size(65536)
for _ in range(1200):
    threading.Thread(target=time.sleep, args=(100,)).start()
print("ready", flush=True)
time.sleep(100)
"""


def start(program: str) -> subprocess.Popen[str]:
    process = subprocess.Popen(
        [sys.executable, "-c", program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, process_group=0
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    return process


def children_of(pid: int) -> list[int]:
    return [int(each) for each in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def test_processes_and_threads_are_counted() -> None:
    threads = len(os.listdir("/proc/self/task"))
    assert excess_of([os.getpid()], max_tasks=threads) == ""
    assert excess_of([os.getpid()], max_tasks=threads - 1) == f"it had more than {threads - 1} processes and threads"
    assert excess_of([]) == ""


def test_a_process_that_has_ended_counts_for_nothing() -> None:
    with subprocess.Popen(["true"]) as ended:
        pass
    assert excess_of([ended.pid], max_tasks=0, max_mb=0) == ""


def test_memory_is_measured() -> None:
    with start(ALLOCATES) as process:
        try:
            assert excess_of([process.pid], max_mb=300) == ""
            assert excess_of([process.pid], max_mb=190) == "it took more than 190 MB of memory"
        finally:
            process.kill()


def test_what_forked_processes_share_counts_once() -> None:
    with start(FORKS) as process:
        try:
            assert len(children_of(process.pid)) == 3
            assert excess_of([process.pid, *children_of(process.pid)], max_mb=400) == ""
        finally:
            os.killpg(process.pid, signal.SIGKILL)


@pytest.mark.timeout(120)
async def test_a_run_above_a_limit_is_ended_and_says_why(tmp_path: Path) -> None:
    argv = [sys.executable, "-c", STARTS_THREADS]
    async with await LearnerProcess.start(argv, env={"PATH": os.environ["PATH"]}, cwd=tmp_path) as process:
        await run_limits.enforce(process)
        ended = await process.wait(60)
        assert ended is not None
        assert ended.signal == signal.SIGKILL
        assert process.output[-1].text == f"Killed: it had more than {run_limits.MAX_TASKS} processes and threads"
        assert process.fault == ""
