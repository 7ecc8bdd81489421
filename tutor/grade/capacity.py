"""How many checks this machine can carry out at once, and how long a class takes."""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import ceil
from pathlib import Path
from statistics import mean

from tutor.grade.results import Result

CHECKS_PER_CORE = 2
"""As many as take turns on a machine (see `tutor.engine.scheduling`): with more, slow nodes cannot be judged."""

CHECK_MB = 800
"""Memory to keep free for one check. Our solutions' took 173 to 343 MB (PSS of all processes); others may take more."""

_CGROUP = Path("/sys/fs/cgroup")


@dataclass(frozen=True, slots=True)
class Cost:
    """What a check takes: `cpu_s` of CPU time, all processes together, and `wall_s` alone on an idle machine."""

    cpu_s: float
    wall_s: float


DEFAULT_COST = Cost(6.0, 6.0)

COSTS: Mapping[str, Cost] = {
    "i1.1": Cost(6.1, 6.4),
    "i1.2": Cost(5.7, 6.1),
    "i1.3": Cost(3.7, 2.1),
    "i2.1": Cost(7.1, 6.4),
    "i2.2": Cost(10.3, 4.9),
    "i2.3": Cost(4.0, 6.8),
}
"""One check of our solution each, alone on 2 idle cores; of i2.2, the CPU time of a whole class's mean.

Wrong submissions often take longer: see `costs_from`.
"""


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
        fields = dict(line.split() for line in (_CGROUP / "memory.stat").read_text().splitlines())
        reclaimable = int(fields.get("inactive_file", "0"))  # of the page cache
        return min(free, (limit - used + reclaimable) / (1 << 20))
    except (OSError, ValueError):
        return free


def checks_at_once() -> int:
    """Return how many checks to run at once here, so that each can still be judged."""
    return max(1, min(int(CHECKS_PER_CORE * cores()), int(memory_mb() / CHECK_MB)))


def costs_from(results: Iterable[Result]) -> dict[str, Cost]:
    """Return the cost of each exercise as measured in earlier results: means, or what is known otherwise."""
    seen: dict[str, list[Result]] = defaultdict(list)
    for result in results:
        if result.status in ("passed", "failed") and result.cpu_s:
            seen[result.exercise].append(result)
    measured = {
        exercise: Cost(
            mean(result.cpu_s for result in results),
            min(COSTS.get(exercise, DEFAULT_COST).wall_s, mean(result.report.duration_s for result in results)),
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
