"""How long a class takes on other machines, by a model of the queue that `tests.benchmarks.grading` checks.

    uv run python -m tests.benchmarks.grading_model [--learners 30 300 3000] [--exercises 6] [--cores 2 8 64]
                                                    [--machines 1 8] [--price 0.04] [--spread 0.05]

A check needs CPU time and, alone on an idle machine, some wall-clock time. Of the checks that run at once, each gets a
share of the cores; one that asks for less than its share is as fast as alone. The next one begins when one ends. A
share of the submissions (`--spread`) hangs, which takes `HANGING` times as long.

Prices are in any currency, for an hour of one core; the table has hours of the clock, and the cost of all cores.
"""

from __future__ import annotations

import argparse
import random
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from tutor.content import load_course
from tutor.grade.capacity import CHECKS_PER_CORE, COSTS, DEFAULT_COST

HANGING = 4.0


@dataclass(frozen=True, slots=True)
class Job:
    """One check: its CPU time, and its duration alone on an idle machine, in seconds."""

    cpu_s: float
    wall_s: float


def simulate(jobs: Iterable[Job], cores: float, slots: int) -> float:
    """Return how long the jobs take in this order, `slots` at once, in seconds.

    Each running job asks for `cpu_s / wall_s` cores. If all together ask for more than there are, those that ask for
    most get less, and all of these the same.
    """
    waiting = iter(jobs)
    running: list[_Running] = []
    now_s = 0.0
    while True:
        while len(running) < slots and (following := next(waiting, None)) is not None:
            alone_s = max(following.wall_s, 1e-9)
            running.append(_Running(alone_s, following.cpu_s / alone_s))
        if not running:
            return now_s
        share = _fair_share([job.demand for job in running], cores)
        step_s = min(job.left_s / job.pace(share) for job in running)
        now_s += step_s
        for job in running:
            job.left_s -= step_s * job.pace(share)
        running = [job for job in running if job.left_s > 1e-9]


@dataclass(slots=True)
class _Running:
    """A running job: what is left of its duration alone, and how many cores it asks for."""

    left_s: float
    demand: float

    def pace(self, share: float) -> float:
        """How fast it is, compared with alone, if it may have this many cores."""
        return 1.0 if self.demand <= share else share / self.demand


def _fair_share(demands: Sequence[float], cores: float) -> float:
    """Return how many cores each may have at most, so that all have together what there is."""
    left = cores
    for place, demand in enumerate(sorted(demands)):
        share = left / (len(demands) - place)
        if demand > share:
            return share
        left -= demand
    return max(demands)


def class_s(
    learners: int, exercises: Sequence[str], cores: float, machines: int, spread: float, seed: int = 1
) -> float:
    """Return how long a class takes on a number of machines, each with an equal part of it, in seconds."""
    chance = random.Random(seed)
    jobs = []
    for _ in range(learners):
        for exercise in exercises:
            cost = COSTS.get(exercise, DEFAULT_COST)
            times = HANGING if chance.random() < spread else 1.0
            jobs.append(Job(times * cost.cpu_s, times * cost.wall_s))
    slots = max(1, int(CHECKS_PER_CORE * cores))
    parts = [sorted(jobs[part::machines], key=lambda job: -job.wall_s) for part in range(machines)]
    return max(simulate(part, cores, slots) for part in parts)


def words(seconds: float) -> str:
    """Return a duration in the unit that fits."""
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def main() -> int:
    """Print a line for each size of a class, machine and number of machines."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--learners", type=int, nargs="+", default=[30, 300, 3000])
    parser.add_argument("--exercises", type=int, default=6, help="the first ones of the course")
    parser.add_argument("--cores", type=float, nargs="+", default=[2, 8, 64])
    parser.add_argument("--machines", type=int, nargs="+", default=[1, 8])
    parser.add_argument("--price", type=float, default=0.04, help="of an hour of one core")
    parser.add_argument("--spread", type=float, default=0.05, help="the share of submissions that hang")
    arguments = parser.parse_args()
    exercises = [lesson.id for lesson in load_course().lessons][: arguments.exercises]
    print(f"{len(exercises)} exercises, {arguments.price:g} for an hour of one core, {arguments.spread:.0%} hang")
    print("| learners | checks | cores | machines | time | cost |")
    print("| ---: | ---: | ---: | ---: | ---: | ---: |")
    for learners in arguments.learners:
        for cores in arguments.cores:
            for machines in arguments.machines:
                seconds = class_s(learners, exercises, cores, machines, arguments.spread)
                cost = seconds / 3600 * cores * machines * arguments.price
                checks = learners * len(exercises)
                print(f"| {learners} | {checks} | {cores:g} | {machines} | {words(seconds)} | {cost:.2f} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
