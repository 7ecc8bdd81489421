import os
import subprocess
import sys
import time

from tutor.process import cpu_time, cpu_time_here

BUSY = "while True: pass"


def test_a_busy_process_is_seen_to_run_and_an_ended_one_no_longer_counts() -> None:
    with subprocess.Popen([sys.executable, "-c", BUSY], start_new_session=True) as process:
        try:
            deadline = time.monotonic() + 30
            while cpu_time(process.pid).ran_s < 0.2 and time.monotonic() < deadline:
                time.sleep(0.01)
            assert cpu_time(process.pid).ran_s >= 0.2
        finally:
            process.kill()
    assert cpu_time(process.pid).ran_s == 0.0


def test_two_on_one_cpu_wait_for_each_other() -> None:
    cpu = min(os.sched_getaffinity(0))
    code = f"import os; os.sched_setaffinity(0, {{{cpu}}})\n{BUSY}"
    both = [subprocess.Popen([sys.executable, "-c", code], start_new_session=True) for _ in range(2)]
    try:
        deadline = time.monotonic() + 30
        while min(cpu_time(each.pid).waited_s for each in both) < 0.2 and time.monotonic() < deadline:
            time.sleep(0.01)
        assert min(cpu_time(each.pid).waited_s for each in both) >= 0.2
    finally:
        for each in both:
            each.kill()
            each.wait()


def test_a_main_thread_that_sleeps_is_not_kept_waiting() -> None:
    cpu = min(os.sched_getaffinity(0))
    pinned = f"import os, threading, time; os.sched_setaffinity(0, {{{cpu}}})\n"
    rest = f"threading.Thread(target=exec, args=({BUSY!r},), daemon=True).start()\ntime.sleep(1000)"
    both = [subprocess.Popen([sys.executable, "-c", pinned + code], start_new_session=True) for code in (BUSY, rest)]
    try:
        deadline = time.monotonic() + 30
        while cpu_time(both[1].pid).waited_s < 0.5 and time.monotonic() < deadline:
            time.sleep(0.01)
        had = cpu_time(both[1].pid)
        assert had.waited_s >= 0.5
        assert had.main_waited_s < had.waited_s / 2
    finally:
        for each in both:
            each.kill()
            each.wait()


def test_our_own_process_has_run() -> None:
    assert cpu_time_here().ran_s > 0.0
