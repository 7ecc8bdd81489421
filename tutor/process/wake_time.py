"""When a process will next do something by itself: the kernel tells what each of its threads waits for.

A ROS node without a timer waits for messages in a futex without a time-out, one with a timer until that is due, and
`time.sleep` until it is over (`/proc/PID/task/TID/syscall`, see proc(5)).
"""

from __future__ import annotations

import math
import os
import platform
import struct
import time
from collections.abc import Iterable
from dataclasses import dataclass

_SYSCALLS = {"x86_64": (202, 230), "aarch64": (98, 115)}
_FUTEX, _CLOCK_NANOSLEEP = _SYSCALLS.get(platform.machine(), (-1, -1))
_FUTEX_WAIT, _FUTEX_WAIT_BITSET = 0, 9
_FUTEX_COMMAND, _FUTEX_CLOCK_REALTIME = 0x7F, 0x100
_TIMER_ABSTIME = 1
_TIMESPEC = struct.Struct("=qq")

_FAST_DDS = b"dds."
"""How Fast DDS names its threads. They send what others have given them, and keep the connections up."""

_FLUSHING_LIBRARY = b"librcl_logging_spdlog.so"
_FLUSH_EVERY_S = 5.0
"""rcl's logging writes its file in a thread of its own, which has no name."""


@dataclass(frozen=True, slots=True)
class NextWake:
    """Of one or more processes: `at`, when one of their threads wakes up by itself, in seconds since the epoch.

    inf: never; 0.0: one may be running, or nothing is known. `timeslices`: how often they have run so far.
    """

    at: float = 0.0
    timeslices: int = 0


def next_wake(pids: Iterable[int]) -> NextWake:
    """Of these processes together; of none, nothing is known."""
    found = [_of_process(pid) for pid in pids]
    return NextWake(min((each.at for each in found), default=0.0), sum(each.timeslices for each in found))


def _of_process(pid: int) -> NextWake:
    wakes: list[float] = []
    background: list[float] = []
    timeslices = 0
    try:
        for thread in os.listdir(f"/proc/{pid}/task"):
            folder = f"/proc/{pid}/task/{thread}"
            if _read(f"{folder}/comm").startswith(_FAST_DDS):
                continue
            (background if thread != str(pid) else wakes).append(_of_thread(pid, _read(f"{folder}/syscall")))
            timeslices += int(_read(f"{folder}/schedstat").split()[2])
        return NextWake(min((*wakes, *_without_flushing(pid, background)), default=0.0), timeslices)
    except (OSError, IndexError, ValueError):  # it is ending, or this kernel does not tell
        return NextWake()


def _of_thread(pid: int, syscall: bytes) -> float:
    """When the thread that is in this system call wakes up by itself."""
    words = syscall.split()
    if len(words) < 7:  # it is running, or about to
        return 0.0
    number, arguments = int(words[0]), [int(word, 16) for word in words[1:7]]
    if number == _FUTEX and arguments[1] & _FUTEX_COMMAND in (_FUTEX_WAIT, _FUTEX_WAIT_BITSET):
        if arguments[3] == 0:
            return math.inf
        if arguments[1] & _FUTEX_COMMAND == _FUTEX_WAIT_BITSET:
            return _time_at(pid, arguments[3], realtime=bool(arguments[1] & _FUTEX_CLOCK_REALTIME))
    if number == _CLOCK_NANOSLEEP and arguments[1] & _TIMER_ABSTIME and arguments[0] in (0, 1):
        return _time_at(pid, arguments[2], realtime=arguments[0] == 0)
    return 0.0


def _time_at(pid: int, address: int, *, realtime: bool) -> float:
    """The absolute time-out (a timespec) at an address of the process, in seconds since the epoch."""
    memory = os.open(f"/proc/{pid}/mem", os.O_RDONLY)
    try:
        seconds, nanoseconds = _TIMESPEC.unpack(os.pread(memory, _TIMESPEC.size, address))
    except struct.error as error:
        raise ValueError("a time-out that cannot be read") from error
    finally:
        os.close(memory)
    at = float(seconds + nanoseconds * 1e-9)
    return at if realtime else at - time.monotonic() + time.time()


def _without_flushing(pid: int, background: list[float]) -> list[float]:
    """Without the thread that flushes the log: of those that wait for no longer than it does, whichever wakes last."""
    due = sorted(at for at in background if 0.0 < at <= time.time() + _FLUSH_EVERY_S)
    if due and _FLUSHING_LIBRARY in _read(f"/proc/{pid}/maps"):
        background.remove(due[-1])
    return background


def _read(path: str) -> bytes:
    with open(path, "rb") as file:
        return file.read()
