"""Limits on what one run of a learner's program takes, all its processes together.

The kernel has no such limits that every user could set, and none at all on the number of root's processes.
"""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Iterable
from contextlib import suppress

from tutor.process.learner import LearnerProcess

MAX_TASKS = 1000
"""Processes and threads of a run; those of our solutions have 13 to 60."""

MAX_MB = 4096
"""Memory of a run in MB; a node has 30 to 60."""

_INTERVAL_S = 0.5
_PAGES_PER_MB = 2**20 // os.sysconf("SC_PAGE_SIZE")


async def enforce(process: LearnerProcess) -> None:
    """End a run once it is above a limit, as the kernel ends what takes too much. Returns when it has ended."""
    while pids := process.pids():
        if excess := excess_of(pids):
            process.kill(excess)
            return
        await asyncio.sleep(_INTERVAL_S)


def excess_of(pids: Iterable[int], max_tasks: int = MAX_TASKS, max_mb: float = MAX_MB) -> str:
    """Return which limit these processes are above together, in a few words; empty if none."""
    pids = list(pids)
    if _sum_of(_count_threads, pids) > max_tasks:
        return f"it had more than {max_tasks} processes and threads"
    # Forked processes share most of their memory, which only the slower way to read it tells.
    if _sum_of(_read_resident_mb, pids) > max_mb and _sum_of(_read_own_mb, pids) > max_mb:
        return f"it took more than {max_mb} MB of memory"
    return ""


def _sum_of(read: Callable[[int], float], pids: Iterable[int]) -> float:
    total = 0.0
    for pid in pids:
        with suppress(OSError, ValueError, StopIteration):  # it has ended
            total += read(pid)
    return total


def _count_threads(pid: int) -> float:
    return len(os.listdir(f"/proc/{pid}/task"))


def _read_resident_mb(pid: int) -> float:
    with open(f"/proc/{pid}/statm", "rb", buffering=0) as file:
        return int(file.read().split()[1]) / _PAGES_PER_MB


def _read_own_mb(pid: int) -> float:
    """Return the memory of a process in MB, with its share of what it shares with others."""
    with open(f"/proc/{pid}/smaps_rollup", "rb") as file:
        return next(int(line.split()[1]) for line in file if line.startswith(b"Pss:")) / 1024
