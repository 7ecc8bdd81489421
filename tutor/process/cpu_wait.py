"""CPU time that a learner's processes got and waited for, to tell a slow program from one that the machine slowed."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Iterable
from dataclasses import astuple, dataclass, replace

from tutor.process.process_table import Process, processes

TABLE_MAX_AGE_S = 0.1
"""Maximum age of the cached process table. Reading it takes milliseconds of CPU, and thirty runs may ask at once."""

OWN_MAX_AGE_S = 0.05
"""Maximum age of our own cached CPU time: while thirty runs are watched, this process has hundreds of threads."""

MAX_EXTENSION_FACTOR = 5
"""A limit is extended by waits for a CPU, by at most this many times the limit: by then, even a process on a very busy
machine has run many times.
"""

_process_table: tuple[float, dict[int, Process]] = (0.0, {})
_own_reading: tuple[float, _ProcessMeter, CpuTime] | None = None


@dataclass(frozen=True, slots=True)
class CpuTime:
    """CPU time of one or more processes so far, in seconds (from `/proc/PID/task/TID/schedstat`).

    `ran_s` is the time spent running, `waited_s` the time spent runnable but waiting for a CPU. Each process counts
    with its highest thread, since threads wait at the same time. `main_waited_s` is the wait of the main threads alone;
    a sleeping thread does not count as waiting. All are 0.0 where the kernel does not report them.
    """

    ran_s: float = 0.0
    waited_s: float = 0.0
    main_waited_s: float = 0.0


class _ProcessMeter:
    """Measures the CPU time of one process.

    It never falls: if the thread that counts ends, the time of the next one is added to what was measured so far.
    """

    def __init__(self, pid: int) -> None:
        self.pid = pid
        self._last = self._ended = CpuTime()

    def read(self) -> CpuTime:
        """Return the CPU time so far; if the process has ended, the last one that was read."""
        if (now := _read_cpu_time(self.pid)) != CpuTime():
            ended = zip(astuple(self._ended), astuple(self._last), astuple(now), strict=True)
            self._ended = CpuTime(*(kept + max(0.0, last - new) for kept, last, new in ended))
            self._last = now
        return CpuTime(*(kept + last for kept, last in zip(astuple(self._ended), astuple(self._last), strict=True)))


class CpuMeter:
    """Measures the CPU time of all processes in a session.

    Processes that were seen once and have ended still count: the time one of them waited is not undone by its exit.
    """

    def __init__(self, session: int) -> None:
        self._session = session
        self._per_process: dict[int, _ProcessMeter] = {}

    @property
    def process_count(self) -> int:
        """The number of processes seen so far, but at least 1."""
        return max(1, len(self._per_process))

    def read(self) -> CpuTime:
        """Return the sum over all processes seen so far.

        `main_waited_s` has the whole wait of the other processes: the first one may be waiting for their end.
        """
        for process in recent_processes(self._session).values():
            if process.session == self._session:
                self._per_process.setdefault(process.pid, _ProcessMeter(process.pid))
        found = [(pid, meter.read()) for pid, meter in self._per_process.items()]
        readings = [
            astuple(cpu_time if pid == self._session else replace(cpu_time, main_waited_s=cpu_time.waited_s))
            for pid, cpu_time in found
        ]
        return CpuTime(*(sum(values) for values in zip(*readings, strict=True)))


def own_cpu_time() -> CpuTime:
    """Return the CPU time of our own process, at most `OWN_MAX_AGE_S` old."""
    global _own_reading
    now, pid = time.monotonic(), os.getpid()
    if _own_reading is None or _own_reading[1].pid != pid or now - _own_reading[0] >= OWN_MAX_AGE_S:
        meter = _own_reading[1] if _own_reading is not None and _own_reading[1].pid == pid else _ProcessMeter(pid)
        _own_reading = (now, meter, meter.read())
    return _own_reading[2]


def estimate_unblocked_s(elapsed_s: float, cpu_waits_s: Iterable[float]) -> float:
    """Estimate for how much of `elapsed_s` seconds no process waited for a CPU.

    `cpu_waits_s` holds how long each one waited; their waits are taken as independent of each other.
    """
    return elapsed_s * math.prod(max(0.0, 1 - wait_s / elapsed_s) for wait_s in cpu_waits_s) if elapsed_s > 0 else 0.0


def recent_processes(pid: int) -> dict[int, Process]:
    """Return the process table, at most `TABLE_MAX_AGE_S` old and read again if it lacks `pid`.

    Only the list of processes is cached: CPU times and wake times are always read afresh.
    """
    global _process_table
    read_at, table = _process_table
    now = time.monotonic()
    if pid not in table or now - read_at >= TABLE_MAX_AGE_S:
        _process_table = (now, processes())
    return _process_table[1]


def _read_cpu_time(pid: int) -> CpuTime:
    ran = waited = main = 0
    try:
        threads = os.listdir(f"/proc/{pid}/task")
    except OSError:  # the process has ended
        threads = []
    for thread in threads:
        try:
            with open(f"/proc/{pid}/task/{thread}/schedstat", "rb") as file:
                fields = file.read().split()
            ran, waited = max(ran, int(fields[0])), max(waited, int(fields[1]))
            if thread == str(pid):
                main = int(fields[1])
        except (OSError, IndexError, ValueError):  # this thread has ended, or this kernel has no such file
            pass
    return CpuTime(ran * 1e-9, waited * 1e-9, main * 1e-9)
