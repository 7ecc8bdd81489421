import os
import subprocess
import sys
import time

import pytest

from tutor.process import CpuMeter, CpuTime, cpu_wait, own_cpu_time
from tutor.process.cpu_wait import estimate_unblocked_s
from tutor.process.process_table import Process

BUSY = "while True: pass"


def test_cpu_time_of_a_busy_process_is_measured_and_kept_after_its_exit() -> None:
    with subprocess.Popen([sys.executable, "-c", BUSY], start_new_session=True) as process:
        meter = CpuMeter(process.pid)
        try:
            deadline = time.monotonic() + 30
            while meter.read().ran_s < 0.2 and time.monotonic() < deadline:
                time.sleep(0.01)
            used = meter.read()
            assert used.ran_s >= 0.2
        finally:
            process.kill()
    after = meter.read()
    assert after.ran_s >= used.ran_s
    assert after.waited_s >= used.waited_s
    assert CpuMeter(process.pid).read().ran_s == 0.0


def test_two_busy_processes_on_one_cpu_wait_for_each_other() -> None:
    cpu = min(os.sched_getaffinity(0))
    code = f"import os; os.sched_setaffinity(0, {{{cpu}}})\n{BUSY}"
    both = [subprocess.Popen([sys.executable, "-c", code], start_new_session=True) for _ in range(2)]
    try:
        meters = [CpuMeter(each.pid) for each in both]
        deadline = time.monotonic() + 30
        while min(meter.read().waited_s for meter in meters) < 0.2 and time.monotonic() < deadline:
            time.sleep(0.01)
        assert min(meter.read().waited_s for meter in meters) >= 0.2
    finally:
        for each in both:
            each.kill()
            each.wait()


def test_a_sleeping_main_thread_does_not_wait_for_the_cpu() -> None:
    cpu = min(os.sched_getaffinity(0))
    pinned = f"import os, threading, time; os.sched_setaffinity(0, {{{cpu}}})\n"
    sleeper = (
        f"threading.Thread(target=exec, args=({BUSY!r},), daemon=True).start()\n"
        "print('up', flush=True)\ntime.sleep(1000)"
    )
    both = [
        subprocess.Popen([sys.executable, "-c", pinned + code], start_new_session=True, stdout=subprocess.PIPE)
        for code in (BUSY, sleeper)
    ]
    try:
        assert both[1].stdout is not None
        assert both[1].stdout.readline() == b"up\n"
        meter, deadline = CpuMeter(both[1].pid), time.monotonic() + 30
        before = meter.read()
        while meter.read().waited_s < before.main_waited_s + 1.0 and time.monotonic() < deadline:
            time.sleep(0.01)
        used = meter.read()
        assert used.waited_s >= before.main_waited_s + 1.0
        assert used.main_waited_s < before.main_waited_s + 0.5
    finally:
        for each in both:
            each.kill()
            each.communicate()


def test_cpu_time_does_not_fall_when_the_thread_that_counts_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    found = iter([CpuTime(2.0, 1.0, 0.5), CpuTime(1.0, 0.5, 0.5), CpuTime(1.5, 0.75, 0.5), CpuTime()])
    monkeypatch.setattr(cpu_wait, "_read_cpu_time", lambda _pid: next(found))
    meter = cpu_wait._ProcessMeter(1)
    assert [meter.read() for _ in range(4)] == [
        CpuTime(2.0, 1.0, 0.5),
        CpuTime(2.0, 1.0, 0.5),
        CpuTime(2.5, 1.25, 0.5),
        CpuTime(2.5, 1.25, 0.5),  # the process has ended
    ]


def test_our_own_cpu_time_is_measured() -> None:
    assert own_cpu_time().ran_s > 0.0


def test_free_time_is_the_time_in_which_no_process_waits() -> None:
    assert estimate_unblocked_s(10, [0, 0]) == 10
    assert estimate_unblocked_s(10, [5, 5]) == 2.5
    assert estimate_unblocked_s(10, [10, 0]) == 0
    assert estimate_unblocked_s(10, [30, 1]) == 0  # several processes that all wait the whole time
    assert estimate_unblocked_s(0, []) == 0


def test_a_child_process_counts_with_its_whole_wait_since_its_parent_may_wait_for_its_end(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found = {1: CpuTime(1.0, 0.5, 0.1), 2: CpuTime(2.0, 3.0, 0.2)}
    table = {pid: Process(pid, parent=1, group=1, session=1, state="S") for pid in found}
    monkeypatch.setattr(cpu_wait, "recent_processes", lambda _session: table)
    monkeypatch.setattr(cpu_wait, "_read_cpu_time", found.__getitem__)
    meter = CpuMeter(1)
    assert meter.process_count == 1
    assert meter.read() == CpuTime(3.0, 3.5, 3.1)
    assert meter.process_count == 2
