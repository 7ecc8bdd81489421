"""CPU time that a learner's processes got and waited for, to tell slow programs from a busy machine."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Iterable
from dataclasses import astuple, dataclass

from tutor.process.supervisor import Process, processes

TABLE_MAX_AGE_S = 0.1
"""Maximum age of the cached process table. Reading it takes milliseconds of CPU, and thirty runs may ask at once."""

OWN_MAX_AGE_S = 0.05
"""Maximum age of our own cached CPU time: while thirty runs are watched, this process has hundreds of threads."""

_process_table: tuple[float, dict[int, Process]] = (0.0, {})
_own_reading: tuple[float, int, CpuTime] | None = None


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


class CpuMeter:
    """Measures the CPU time of all processes in a session.

    Processes that were seen once and have ended still count: the time one of them waited is not undone by its exit.
    """

    def __init__(self, session: int) -> None:
        self._session = session
        self._per_process: dict[int, CpuTime] = {}

    def read(self) -> CpuTime:
        """Return the sum over all processes seen so far."""
        for process in recent_processes(self._session).values():
            if process.session == self._session and (cpu_time := _read_cpu_time(process.pid)) != CpuTime():
                self._per_process[process.pid] = cpu_time
        return CpuTime(*(sum(values) for values in zip(*map(astuple, self._per_process.values()), strict=True)))


def own_cpu_time() -> CpuTime:
    """Return the CPU time of our own process, at most `OWN_MAX_AGE_S` old."""
    global _own_reading
    now, pid = time.monotonic(), os.getpid()
    if _own_reading is None or _own_reading[1] != pid or now - _own_reading[0] >= OWN_MAX_AGE_S:
        _own_reading = (now, pid, _read_cpu_time(pid))
    return _own_reading[2]


def estimate_unblocked_s(elapsed_s: float, cpu_waits_s: Iterable[float]) -> float:
    """Estimate for how much of `elapsed_s` seconds no process waited for a CPU.

    `cpu_waits_s` holds how long each one waited; their waits are taken as independent of each other.
    """
    return elapsed_s * math.prod(max(0.0, 1 - each / elapsed_s) for each in cpu_waits_s) if elapsed_s > 0 else 0.0


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
        for thread in os.listdir(f"/proc/{pid}/task"):
            with open(f"/proc/{pid}/task/{thread}/schedstat", "rb") as file:
                fields = file.read().split()
            ran, waited = max(ran, int(fields[0])), max(waited, int(fields[1]))
            if thread == str(pid):
                main = int(fields[1])
    except (OSError, IndexError, ValueError):  # the process ended meanwhile, or this kernel has no such file
        pass
    return CpuTime(ran * 1e-9, waited * 1e-9, main * 1e-9)
