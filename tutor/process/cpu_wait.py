"""What a learner's processes had of the CPU: on a crowded machine, slowness is not theirs."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Iterable
from dataclasses import astuple, dataclass

from tutor.process.supervisor import Process, processes

TABLE_EVERY_S = 0.1
"""How old the table of processes may be. To read it takes some milliseconds of CPU, and thirty runs ask at once."""

OWN_EVERY_S = 0.05
"""How old the CPU time of our own process may be: it has hundreds of threads when thirty runs are watched."""

_process_table: tuple[float, dict[int, Process]] = (0.0, {})
_own: tuple[float, int, CpuTime] | None = None


@dataclass(frozen=True, slots=True)
class CpuTime:
    """CPU time of one or more processes so far, in seconds.

    `ran_s`: how long they ran; `waited_s`: how long they were able to run, but were not let. Of each process the thread
    with the most of it counts, since threads wait at the same time (`/proc/PID/task/TID/schedstat`). 0.0 where the
    kernel does not tell. `main_waited_s`: the same of their main threads only, which do not wait while they sleep.
    """

    ran_s: float = 0.0
    waited_s: float = 0.0
    main_waited_s: float = 0.0


class CpuMeter:
    """Reads what the processes of a session had of the CPU.

    Those that have ended since it first saw them go on counting: what one of several waited is not given back when it
    is gone.
    """

    def __init__(self, session: int) -> None:
        self._session = session
        self._per_process: dict[int, CpuTime] = {}

    def read(self) -> CpuTime:
        """The sum of all processes so far."""
        for process in recent_processes(self._session).values():
            if process.session == self._session and (had := _read_cpu_time(process.pid)) != CpuTime():
                self._per_process[process.pid] = had
        return CpuTime(*(sum(values) for values in zip(*map(astuple, self._per_process.values()), strict=True)))


def own_cpu_time() -> CpuTime:
    """The same for our own process, read again where it is old."""
    global _own
    now, pid = time.monotonic(), os.getpid()
    if _own is None or _own[1] != pid or now - _own[0] >= OWN_EVERY_S:
        _own = (now, pid, _read_cpu_time(pid))
    return _own[2]


def free_s(of_s: float, late_s: Iterable[float]) -> float:
    """For how much of `of_s` seconds nobody was kept waiting; each was for so long, whatever the others did then."""
    return of_s * math.prod(max(0.0, 1 - each / of_s) for each in late_s) if of_s > 0 else 0.0


def recent_processes(pid: int) -> dict[int, Process]:
    """The table of processes, read again where it is old or lacks `pid`; the numbers of each are never old."""
    global _process_table
    read_at, table = _process_table
    now = time.monotonic()
    if pid not in table or now - read_at >= TABLE_EVERY_S:
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
    except (OSError, IndexError, ValueError):  # it ended while it was read, or this kernel has no such file
        pass
    return CpuTime(ran * 1e-9, waited * 1e-9, main * 1e-9)
