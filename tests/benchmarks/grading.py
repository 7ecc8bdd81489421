"""How long `ros-tutor grade` takes for a class, with how much memory, and whether every verdict is as it must be.

    uv run python -m tests.benchmarks.grading [--learners 30] [--exercises i1.1 i2.2] [--jobs N] [--seed 1]
                                              [--executor dask] [--no-isolation] [--keep FOLDER]

The class is made of the test submissions (see `tests.grade.classes`). Printed are the wall-clock time, the CPU time of
all processes, and the ratio of the former to what the machine allows: the larger of CPU time / cores and the sum of the
floors / checks at once, where a check's floor is the longest wait that its criteria ask for, or its duration if that is
less. Memory is counted for all processes of the run together.
"""

from __future__ import annotations

import argparse
import os
import re
import resource
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import mean, median

from tests.benchmarks.grading_model import Job, simulate
from tests.grade.classes import MadeClass, make_class
from tests.grade.grade_process import GradeProcess
from tutor.content import load_course
from tutor.engine.loading import load_check
from tutor.grade.capacity import COSTS, DEFAULT_COST, cores, estimate_s
from tutor.grade.results import Result, ResultFolder

ALLOWED_RATIO = 1.25


@dataclass(frozen=True)
class Run:
    """One whole run. `wall_s` and `cpu_s` in seconds; `slots`: checks at once."""

    results: Sequence[Result]
    code: int
    wall_s: float
    cpu_s: float
    busy_s: float
    peak_mb: float
    slots: int
    left: Sequence[str]


def words_for(made: MadeClass, results: Path, arguments: argparse.Namespace) -> list[str | Path]:
    """Return the arguments of `ros-tutor grade`."""
    words: list[str | Path] = [made.folder, "--roster", made.roster, "--output", results, "--format", "csv"]
    for exercise in arguments.exercises:
        words += ["--exercise", exercise]
    if arguments.jobs:
        words += ["--jobs", str(arguments.jobs)]
    if arguments.executor != "local":
        words += ["--executor", arguments.executor]
    return [*words, *([] if arguments.isolate else ["--no-isolation"])]


def run(words: Sequence[str | Path], results: Path, temporary: Path) -> Run:
    """Grade from the beginning to the end."""
    before, began, busy_before = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter(), busy_s()
    grade = GradeProcess(words, temporary, look_every_s=3.0)  # looking takes CPU itself
    code = grade.wait()
    wall_s, after = time.perf_counter() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
    busy = busy_s() - busy_before
    said = grade.err.read_text(errors="replace")
    slots = re.search(r"(\d+) checks? at once", said)
    if code not in (0, 3) or slots is None:
        raise SystemExit(f"grade ended with exit code {code}:\n{said[-3000:]}")
    print("\n".join(line for line in said.splitlines() if "at once" in line or "not judged" in line), flush=True)
    cpu_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    left = [*grade.left_running(), *grade.left_files(), *map(str, results.rglob("*.tmp"))]
    return Run(list(ResultFolder(results)), code, wall_s, cpu_s, busy, grade.peak_mb, int(slots[1]), left)


def busy_s() -> float:
    """Return how long the CPUs of this machine have been busy since it started, all together, in seconds."""
    user, nice, system, _, _, irq, softirq, *_ = map(int, Path("/proc/stat").read_text().split("\n")[0].split()[1:])
    return (user + nice + system + irq + softirq) / os.sysconf("SC_CLK_TCK")


def floors_s(results: Sequence[Result]) -> float:
    """Return the sum of the floors of all checks, in seconds."""
    course = load_course()
    expected = {exercise: load_check(course.find(exercise)).expected_s for exercise in {r.exercise for r in results}}
    return sum(min(expected[result.exercise], result.report.duration_s) for result in judged(results))


def judged(results: Sequence[Result]) -> list[Result]:
    """Return the results for which a check was run."""
    return [result for result in results if result.status != "missing"]


def predict_s(results: Sequence[Result], slots: int, *, measured: bool) -> float:
    """Return what the model of the queue says. `measured`: with the CPU time of each check, rather than the usual."""
    jobs = []
    for result in judged(results):
        cost = COSTS.get(result.exercise, DEFAULT_COST)
        jobs.append(Job(result.cpu_s if measured else cost.cpu_s, cost.wall_s))
    return simulate(sorted(jobs, key=lambda job: -job.wall_s), cores(), slots)


def report(made: MadeClass, run: Run) -> bool:
    """Print the figures of a run; return whether all is as it must be."""
    checks = judged(run.results)
    floor_s = floors_s(run.results)
    bound_s = max(run.cpu_s / cores(), floor_s / run.slots)
    estimate = estimate_s((result.exercise for result in checks), COSTS, run.slots, cores())
    deviations = made.deviations(run.results)
    print(f"{len(run.results)} results, {len(checks)} checks, {run.slots} at once on {cores():g} cores")
    print(f"wall-clock time        {run.wall_s:8.1f} s")
    print(f"CPU time               {run.cpu_s:8.1f} s, of which checks {sum(r.cpu_s for r in checks):.1f} s")
    print(f"the machine was busy   {run.busy_s:8.1f} s of CPU, whoever used it")
    print(f"sum of floors          {floor_s:8.1f} s")
    print(f"bound                  {bound_s:8.1f} s")
    print(f"ratio                  {run.wall_s / bound_s:8.2f}   (asked: at most {ALLOWED_RATIO})")
    print(f"peak memory            {run.peak_mb:8.0f} MB")
    print(f"estimate               {estimate:8.1f} s  ({estimate / run.wall_s:.2f} of the real time)")
    for measured, name in ((False, "usual"), (True, "measured")):
        predicted = predict_s(run.results, run.slots, measured=measured)
        print(f"model, {name:<8} costs  {predicted:8.1f} s  ({predicted / run.wall_s:.2f} of the real time)")
    heads = f"{'median':>9}{'mean':>7}{'max':>7}" * 2
    print(f"{'exercise':<10}{'checks':>7}{'CPU s:':>9}{'':14}{'wall s:':>9}\n{'':17}{heads}")
    for exercise in sorted({result.exercise for result in checks}):
        cpu = [result.cpu_s for result in checks if result.exercise == exercise]
        wall = [result.report.duration_s for result in checks if result.exercise == exercise]
        figures = "".join(f"{median(times):>9.1f}{mean(times):>7.1f}{max(times):>7.1f}" for times in (cpu, wall))
        print(f"{exercise:<10}{len(cpu):>7}{figures}")
    repeated = [result for result in checks if result.attempt > 1]
    errors = [result for result in checks if result.status == "error"]
    print(f"{len(repeated)} repeated, {len(errors)} not judged, exit code {run.code}")
    print(f"{len(deviations)} wrong verdicts", *deviations, sep="\n    ")
    if run.left:
        print("left over:", *run.left, sep="\n    ")
    return not deviations and not run.left and run.wall_s <= ALLOWED_RATIO * bound_s


def main() -> int:
    """Return exit code 0 if every verdict is right, nothing is left over, and the ratio is as asked."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--learners", type=int, default=30)
    parser.add_argument("--exercises", nargs="+", default=["i1.1", "i2.2"], metavar="ID")
    parser.add_argument("--seed", type=int, default=1, help="another seed makes another class")
    parser.add_argument("--jobs", type=int, help="checks at once; 1 measures what a check takes alone")
    parser.add_argument("--executor", default="local")
    parser.add_argument("--no-isolation", dest="isolate", action="store_false")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="keep the class and the results there")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="grading-") as folder:
        base = arguments.keep or Path(folder)
        made = make_class(base, arguments.learners, arguments.exercises, arguments.seed)
        words = words_for(made, base / "results", arguments)
        good = report(made, run(words, base / "results", Path(folder, "tmp")))
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
