"""How long a learner's processes have waited for a CPU: on a crowded machine, slowness is not theirs."""

from __future__ import annotations

import os

from tutor.process.warden import processes


def ran(session: int) -> float:
    """Seconds of CPU that the processes of a session have used so far, each counted by its busiest thread."""
    return sum(_most(process.pid, 0) for process in processes().values() if process.session == session)


def waited_for_cpu(session: int) -> float:
    """Seconds that the processes of a session have spent able to run but not running, so far.

    Of each process its most delayed thread counts (/proc/PID/task/TID/schedstat, second field); 0.0 where the kernel
    does not tell.
    """
    return sum(_most(process.pid, 1) for process in processes().values() if process.session == session)


def waited_for_cpu_here() -> float:
    """The same for our own process."""
    return _most(os.getpid(), 1)


def _most(pid: int, field: int) -> float:
    most = 0
    try:
        for thread in os.listdir(f"/proc/{pid}/task"):
            with open(f"/proc/{pid}/task/{thread}/schedstat", "rb") as file:
                most = max(most, int(file.read().split()[field]))
    except (OSError, IndexError, ValueError):  # it ended while it was read, or this kernel has no such file
        pass
    return most * 1e-9
