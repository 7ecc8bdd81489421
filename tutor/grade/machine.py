"""How many checks this machine can carry out at once, and how long a class takes."""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import ceil
from pathlib import Path
from statistics import median

from tutor.grade.results import Result

CHECKS_PER_CORE = 2
"""As many as take turns on a machine (see `tutor.engine.turns`): with more, slow nodes cannot be judged."""

CHECK_MB = 800
"""Memory of one check: the engine and up to eight nodes at once; 500 to 750 MB were measured."""

_CGROUP = Path("/sys/fs/cgroup")


@dataclass(frozen=True, slots=True)
class Cost:
    """What a check takes: `cpu_s` of CPU time, all processes together, and `wall_s` alone on an idle machine."""

    cpu_s: float
    wall_s: float


DEFAULT_COST = Cost(9.0, 12.0)

COSTS: Mapping[str, Cost] = {
    "i1.1": Cost(9.0, 9.0),
    "i1.2": Cost(7.0, 15.0),
    "i1.3": Cost(9.0, 10.0),
    "i2.1": Cost(12.0, 12.0),
    "i2.2": Cost(12.0, 10.0),
    "i2.3": Cost(6.0, 13.0),
}
"""Measured on 2 cores with a mix of right and wrong submissions (`tests.benchmarks.grading`)."""


def cores() -> float:
    """Return how many cores this process may use, a container's quota included."""
    available = float(len(os.sched_getaffinity(0)))
    try:
        quota, period = (_CGROUP / "cpu.max").read_text().split()
        return max(min(available, int(quota) / int(period)), 0.5)
    except (OSError, ValueError):  # no such file, or "max"
        return available


def memory_mb() -> float:
    """Return the free memory in MB, a container's limit included."""
    fields = dict(line.split(":", 1) for line in Path("/proc/meminfo").read_text().splitlines())
    free = int(fields["MemAvailable"].split()[0]) / 1024
    try:
        limit, used = (int((_CGROUP / name).read_text()) for name in ("memory.max", "memory.current"))
        return min(free, (limit - used) / (1 << 20))
    except (OSError, ValueError):
        return free


def checks_at_once() -> int:
    """Return how many checks to run at once here, so that each can still be judged."""
    return max(1, min(int(CHECKS_PER_CORE * cores()), int(memory_mb() / CHECK_MB)))


def costs_from(results: Iterable[Result]) -> dict[str, Cost]:
    """Return the cost of each exercise as measured in earlier results: medians, or what is known otherwise."""
    seen: dict[str, list[Result]] = defaultdict(list)
    for result in results:
        if result.status in ("passed", "failed") and result.cpu_s:
            seen[result.exercise].append(result)
    measured = {
        exercise: Cost(
            median(result.cpu_s for result in results),
            min(COSTS.get(exercise, DEFAULT_COST).wall_s, median(result.report.duration_s for result in results)),
        )
        for exercise, results in seen.items()
        if len(results) >= 3
    }
    return {**COSTS, **measured}


def estimate_s(exercises: Iterable[str], costs: Mapping[str, Cost], slots: int, available_cores: float) -> float:
    """Return how long the checks of these exercises take together, in seconds."""
    wanted = [costs.get(exercise, DEFAULT_COST) for exercise in exercises]
    if not wanted:
        return 0.0
    cpu_s = sum(cost.cpu_s for cost in wanted) / available_cores
    wall_s = sum(cost.wall_s for cost in wanted) / slots
    return max(cpu_s, wall_s, max(cost.wall_s for cost in wanted))


def words_for(seconds: float) -> str:
    """Return a duration as people say it: "40 seconds", "21 minutes", "3 hours"."""
    if seconds < 90:
        return f"{max(10, ceil(seconds / 10) * 10)} seconds"
    return f"{ceil(seconds / 60)} minutes" if seconds < 5400 else f"{seconds / 3600:.1f} hours"
