"""How long a learner's processes have waited for a CPU: on a crowded machine, slowness is not theirs."""

from __future__ import annotations

import os

from tutor.process.warden import processes


def waited_for_cpu(session: int) -> float:
    """Seconds that the processes of a session have spent able to run but not running, so far.

    Of each process its most delayed thread counts (/proc/PID/task/TID/schedstat, second field); 0.0 where the kernel
    does not tell.
    """
    return sum(_longest_wait(process.pid) for process in processes().values() if process.session == session)


def waited_for_cpu_here() -> float:
    """The same for our own process."""
    return _longest_wait(os.getpid())


def _longest_wait(pid: int) -> float:
    longest = 0
    try:
        for thread in os.listdir(f"/proc/{pid}/task"):
            with open(f"/proc/{pid}/task/{thread}/schedstat", "rb") as file:
                longest = max(longest, int(file.read().split()[1]))
    except (OSError, IndexError, ValueError):  # it ended while it was read, or this kernel has no such file
        pass
    return longest * 1e-9
