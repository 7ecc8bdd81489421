"""Grades a class again while it is disturbed, and compares the results with those of an undisturbed run.

    uv run python -m tests.benchmarks.grading --keep FOLDER
    uv run python -m tests.benchmarks.grading_disturbed FOLDER [--kills 10] [--workers 4 --lost 2] [--seed 1]

`--kills`: `grade` is ended by SIGKILL at random moments, and started again each time. `--workers`: it grades on as many
Dask workers of this machine, of which `--lost` are ended by SIGKILL while they check. In the end, the results must be
those of the undisturbed run but for times and what was measured, and nothing may be left over.
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Sequence
from pathlib import Path

from tests.grade.dask_processes import Processes, is_checking, processes
from tests.grade.grade_process import GradeProcess
from tutor.grade.capacity import COSTS, checks_at_once, cores, estimate_s
from tutor.grade.dask_cluster import connect
from tutor.grade.results import Result, ResultFolder

Words = Sequence[str | Path]
LIMIT_S = 3600.0


def facts_of(result: Result) -> dict[str, object]:
    """Return what must be the same in each run: no times, and no text, in which there may be measured values."""
    criteria = result.judged.criteria if result.judged is not None else ()
    return {
        "learner": result.learner,
        "digest": result.digest,
        "version": result.version,
        "status": result.status,
        "criteria": {each.id: (each.verdict.status.value, each.verdict.mistake) for each in criteria},
    }


def print_differences(undisturbed: Iterable[Result], disturbed: Iterable[Result]) -> bool:
    """Print in what the results differ; return whether they do not."""
    expected, found = (
        {(result.learner.id, result.exercise): facts_of(result) for result in results}
        for results in (undisturbed, disturbed)
    )
    differences = [key for key in expected.keys() | found.keys() if expected.get(key) != found.get(key)]
    print(f"{len(found)} results, of which {len(differences)} differ from the undisturbed run")
    for key in sorted(differences):
        print(f"    {key}:\n        {expected.get(key)}\n        {found.get(key)}")
    return not differences


def finish(words: Words, results: Path, temporary: Path, undisturbed: Sequence[Result]) -> bool:
    """Let `grade` end; return whether the results are those of the undisturbed run, and nothing is left over."""
    grade = GradeProcess(words, temporary)
    code = grade.wait(LIMIT_S)
    left = [*grade.left_running(), *grade.left_files(), *map(str, results.rglob("*.tmp"))]
    print(f"exit code {code}; left over: {', '.join(left) or 'nothing'}")
    return print_differences(undisturbed, ResultFolder(results)) and not left


def kill_again_and_again(
    words: Words, results: Path, temporary: Path, kills: int, whole_s: float, chance: random.Random
) -> bool:
    """Kill `grade` at random moments of `whole_s`; return whether no result was lost or damaged by it."""
    slowest_s, kept = 0.0, [0]
    for number in range(1, kills + 1):
        after_s = chance.uniform(0.0, 2 * whole_s / kills)
        grade = GradeProcess(words, temporary)
        try:
            grade.process.wait(after_s)
        except subprocess.TimeoutExpired:
            gone_s = grade.kill()
        else:
            print(f"kill {number}: it had ended before")
            return True
        slowest_s = max(slowest_s, gone_s)
        broken = [str(path) for path in results.rglob("*.json") if not _is_whole(path)]
        kept.append(len(list(ResultFolder(results))))
        print(f"kill {number}: after {after_s:.1f} s, gone after {gone_s:.1f} s, {kept[-1]} results", flush=True)
        if broken or kept[-1] < kept[-2]:
            print(f"damaged: {', '.join(broken)}")
            return False
    print(f"killed {kills} times; all processes were gone after {slowest_s:.1f} s at most")
    return True


def _is_whole(path: Path) -> bool:
    try:
        json.loads(path.read_text(encoding="utf-8"))
    except ValueError:
        return False
    return True


def grade_on_workers(
    words: Words,
    temporary: Path,
    cluster: Processes,
    workers: int,
    lost: int,
    undisturbed: Sequence[Result],
    results: Path,
) -> bool:
    """Grade on Dask workers, of which some are killed while they check; return whether all is as it must be."""
    pids = [cluster.worker() for _ in range(workers)]
    with connect(cluster.address, 0) as client:
        client.wait_for_workers(workers, timeout=LIMIT_S)
    words = [*words, "--executor", "dask", "--scheduler", cluster.address]
    began = time.perf_counter()
    grade = GradeProcess(words, temporary)
    for number in range(1, lost + 1):
        wanted = len(undisturbed) * number // (lost + 1)
        while len(list(ResultFolder(results))) < wanted or not any(is_checking(pid) for pid in pids):
            if grade.process.poll() is not None:
                raise SystemExit(f"grade has ended: {grade.err.read_text()[-2000:]}")
            time.sleep(0.1)
        victim = next(pid for pid in pids if is_checking(pid))
        pids.remove(victim)
        cluster.kill(victim)
        print(f"killed worker {victim} after {wanted} results", flush=True)
    code = grade.wait(LIMIT_S)
    print(f"exit code {code} after {time.perf_counter() - began:.0f} s")
    print(*(line for line in grade.err.read_text().splitlines() if "worker" in line), sep="\n")
    left = [*grade.left_files(), *map(str, results.rglob("*.tmp"))]
    print(f"left over: {', '.join(left) or 'nothing'}")
    return print_differences(undisturbed, ResultFolder(results)) and not left


def main() -> int:
    """Return exit code 0 if the results are those of the undisturbed run, and nothing is left over."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="what `grading --keep` has made")
    parser.add_argument("--kills", type=int, default=0, metavar="N")
    parser.add_argument("--workers", type=int, default=0, metavar="N")
    parser.add_argument("--lost", type=int, default=2, metavar="N")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    undisturbed = list(ResultFolder(arguments.folder / "results"))
    exercises = [word for exercise in sorted({r.exercise for r in undisturbed}) for word in ("--exercise", exercise)]
    good = True
    with tempfile.TemporaryDirectory(prefix="grading-") as folder:
        for name, wanted in (("killed", arguments.kills), ("dask", arguments.workers)):
            if not wanted:
                continue
            results, temporary = Path(folder, name), Path(folder, f"tmp-{name}")
            words: Words = [arguments.folder / "class", "--roster", arguments.folder / "roster.csv", *exercises]
            words = [*words, "--output", results, "--format", "csv"]
            if name == "killed":
                checks = [result.exercise for result in undisturbed if result.status != "missing"]
                whole_s = estimate_s(checks, COSTS, checks_at_once(), cores())
                chance = random.Random(arguments.seed)
                good &= kill_again_and_again(words, results, temporary, wanted, whole_s, chance)
                good &= finish(words, results, temporary, undisturbed)
            else:
                Path(folder, "cluster").mkdir()
                with processes(Path(folder, "cluster")) as cluster:
                    good &= grade_on_workers(words, temporary, cluster, wanted, arguments.lost, undisturbed, results)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
