"""When a process will next wake up by itself, judged by the system call in which each of its threads waits.

A ROS node without a timer waits for messages in a futex without a timeout; one with a timer waits until that is due,
and `time.sleep` until it is over (`/proc/PID/task/TID/syscall`, see proc(5)). The event loop of asyncio, and so of a
launch, waits in epoll without a timeout if it has no timer; if it has one, it is not known when that is due.
"""

from __future__ import annotations

import math
import os
import platform
import struct
import time
from collections.abc import Iterable
from dataclasses import dataclass

_SYSCALLS = {"x86_64": (202, 230, (232, 281)), "aarch64": (98, 115, (22,))}
_FUTEX, _CLOCK_NANOSLEEP, _EPOLL_WAITS = _SYSCALLS.get(platform.machine(), (-1, -1, ()))
_FUTEX_WAIT, _FUTEX_WAIT_BITSET = 0, 9
_FUTEX_COMMAND, _FUTEX_CLOCK_REALTIME = 0x7F, 0x100
_TIMER_ABSTIME = 1
_NO_EPOLL_TIMEOUT = 0xFFFFFFFF  # -1, in the 32 bits that an int has
_TIMESPEC = struct.Struct("=qq")

_FAST_DDS_PREFIX = b"dds."
"""Prefix of Fast DDS thread names. They send queued data and keep connections alive, so their wake-ups do not count."""

_FLUSHING_LIBRARY = b"librcl_logging_spdlog.so"
_FLUSH_INTERVAL_S = 5.0
"""rcl's logging flushes its file every 5 s from a dedicated thread, which has no name of its own."""

_ThreadWake = tuple[float, int]
"""When a thread wakes up by itself, and how often it has been scheduled."""


@dataclass(frozen=True, slots=True)
class NextWake:
    """When a thread of one or more processes next wakes up by itself.

    `at` is in seconds since the epoch: inf means never, 0.0 that one may be running or nothing is known. `timeslices`
    counts how often the threads that were read have been scheduled so far, except for the one that flushes the log.
    """

    at: float = 0.0
    timeslices: int = 0


def next_wake(pids: Iterable[int], by: float = 0.0) -> NextWake:
    """Return the earliest wake-up of these processes; unknown (0.0) if there are none.

    Reading all threads costs milliseconds, so the search ends at one that wakes up by `by`, in seconds since the epoch.
    """
    found: list[NextWake] = []
    for pid in pids:
        found.append(_process_wake(pid, by))
        if found[-1].at <= by:
            break
    return NextWake(min((wake.at for wake in found), default=0.0), sum(wake.timeslices for wake in found))


def _process_wake(pid: int, by: float) -> NextWake:
    main: list[_ThreadWake] = []
    background: list[_ThreadWake] = []
    try:
        for thread in sorted(os.listdir(f"/proc/{pid}/task"), key=str(pid).__ne__):  # the main thread first
            folder = f"/proc/{pid}/task/{thread}"
            if _read_file(f"{folder}/comm").startswith(_FAST_DDS_PREFIX):
                continue
            is_main = thread == str(pid)
            wake = _thread_wake(pid, _read_file(f"{folder}/syscall"))
            (main if is_main else background).append((wake, int(_read_file(f"{folder}/schedstat").split()[2])))
            if wake <= by and (is_main or wake == 0.0):  # the log-flushing thread is known only from all of them
                return NextWake(wake, sum(slices for _, slices in (*main, *background)))
        threads = [*main, *_drop_flusher(pid, background)]
        return NextWake(min((wake for wake, _ in threads), default=0.0), sum(slices for _, slices in threads))
    except (OSError, IndexError, ValueError):  # the process is ending, or this kernel has no such files
        return NextWake()


def _thread_wake(pid: int, syscall: bytes) -> float:
    """Return when a thread in this system call wakes up by itself, as in `NextWake.at`."""
    words = syscall.split()
    if len(words) < 7:  # running or runnable
        return 0.0
    number, arguments = int(words[0]), [int(word, 16) for word in words[1:7]]
    if number == _FUTEX and arguments[1] & _FUTEX_COMMAND in (_FUTEX_WAIT, _FUTEX_WAIT_BITSET):
        if arguments[3] == 0:
            return math.inf
        if arguments[1] & _FUTEX_COMMAND == _FUTEX_WAIT_BITSET:
            return _read_timeout(pid, arguments[3], realtime=bool(arguments[1] & _FUTEX_CLOCK_REALTIME))
    if (
        number in _EPOLL_WAITS and arguments[3] & _NO_EPOLL_TIMEOUT == _NO_EPOLL_TIMEOUT
    ):  # asyncio's event loop without a timer
        return math.inf
    if number == _CLOCK_NANOSLEEP and arguments[1] & _TIMER_ABSTIME and arguments[0] in (0, 1):
        return _read_timeout(pid, arguments[2], realtime=arguments[0] == 0)
    return 0.0


def _read_timeout(pid: int, address: int, *, realtime: bool) -> float:
    """Read an absolute timeout (a timespec) from the memory of a process, in seconds since the epoch."""
    memory = os.open(f"/proc/{pid}/mem", os.O_RDONLY)
    try:
        seconds, nanoseconds = _TIMESPEC.unpack(os.pread(memory, _TIMESPEC.size, address))
    except struct.error as error:
        raise ValueError("a timeout that cannot be read") from error
    finally:
        os.close(memory)
    at = float(seconds + nanoseconds * 1e-9)
    return at if realtime else at - time.monotonic() + time.time()


def _drop_flusher(pid: int, background: list[_ThreadWake]) -> list[_ThreadWake]:
    """Drop the log-flushing thread: the last to wake of those that wait no longer than its interval.

    Should that be another one, it is the flusher's own wake-up that counts, and the process is not idle.
    """
    due = sorted(thread_wake for thread_wake in background if 0.0 < thread_wake[0] <= time.time() + _FLUSH_INTERVAL_S)
    if due and _FLUSHING_LIBRARY in _read_file(f"/proc/{pid}/maps"):
        background.remove(due[-1])
    return background


def _read_file(path: str) -> bytes:
    with open(path, "rb", buffering=0) as file:
        return file.read()
