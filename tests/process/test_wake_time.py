"""When a process will next act on its own."""

from __future__ import annotations

import math
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from tutor.process.wake_time import NextWake, next_wake

LIMIT_S = 30.0


@contextmanager
def running(code: str) -> Iterator[int]:
    """Run a program that has printed that it is up; yield its pid."""
    command = [sys.executable, "-I", "-S", "-c", f"import threading, time\nprint('up', flush=True)\n{code}"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline() == b"up\n"
            yield process.pid
        finally:
            process.kill()


def wait_until_asleep(pid: int) -> NextWake:
    """Return the next wake-up once no thread has run for a moment: threads are read one after another."""
    deadline, before = time.monotonic() + LIMIT_S, NextWake()
    while (found := next_wake([pid])).at == 0.0 or found.timeslices != before.timeslices:
        assert time.monotonic() < deadline
        before = found
        time.sleep(0.05)
    return found


@pytest.mark.parametrize(
    "code",
    [
        "threading.Event().wait()",
        "threading.Thread(target=threading.Event().wait).start()",
        "lock = threading.Lock()\nlock.acquire()\nlock.acquire()",
        "import asyncio; asyncio.run(asyncio.Event().wait())",
    ],
    ids=["event", "thread", "deadlock", "asyncio"],
)
def test_an_endless_wait_has_no_wake_up(code: str) -> None:
    with running(code) as pid:
        first = wait_until_asleep(pid)
        assert first.at == math.inf
        assert next_wake([pid]) == first  # it has not run in between


@pytest.mark.parametrize(
    "code",
    ["time.sleep(60)", "threading.Event().wait(60)", "threading.Thread(target=time.sleep, args=(60,)).start()"],
    ids=["sleep", "event", "thread"],
)
def test_a_sleep_wakes_up_at_its_end(code: str) -> None:
    with running(code) as pid:
        assert wait_until_asleep(pid).at == pytest.approx(time.time() + 60, abs=20)


@pytest.mark.parametrize(
    "code",
    [
        "while True: pass",
        "import select; select.select([], [], [], 60)",
        "import sys; sys.stdin.read()",
        "import asyncio; asyncio.run(asyncio.sleep(60))",
    ],
    ids=["busy", "select", "input", "asyncio sleep"],
)
def test_the_wake_up_of_other_states_is_unknown(code: str) -> None:
    with running(code) as pid:
        assert next_wake([pid]).at == 0.0


def test_the_earliest_wake_up_of_several_processes_counts() -> None:
    with running("threading.Event().wait()") as idle, running("time.sleep(60)") as sleeper:
        wait_until_asleep(idle)
        wait_until_asleep(sleeper)
        assert next_wake([idle, sleeper]).at == pytest.approx(time.time() + 60, abs=20)
        assert next_wake([idle, sleeper, 2**22 + 1]).at == 0.0


def test_the_search_ends_at_one_that_wakes_up_early_enough() -> None:
    with running("threading.Event().wait()") as idle, running("time.sleep(60)") as sleeper:
        slept = wait_until_asleep(sleeper)
        wait_until_asleep(idle)
        assert next_wake([sleeper, idle], by=time.time() + 120).timeslices == slept.timeslices
        assert next_wake([sleeper, 2**22 + 1], by=time.time() + 120).at == pytest.approx(slept.at, abs=0.1)
        assert next_wake([sleeper, 2**22 + 1], by=time.time() + 1).at == 0.0


def test_the_wake_up_of_no_process_is_unknown() -> None:
    assert next_wake([]) == NextWake()
