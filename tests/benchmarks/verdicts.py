"""How soon a learner gets feedback: the first failed criterion and the whole verdict, over the test submissions.

    uv run python -m tests.benchmarks.verdicts [EXERCISE[/KIND[/NAME]] ...] [--sample] [--ready] [--jobs 2] [--times 1]

For each exercise: its solution, alone, with the longest wait that its criteria ask for, then its wrong and its right
submissions (KIND is one of these two). Each is timed from the start of its process; with `--ready`, as in the app after
the first check: from the moment at which an engine that has prepared itself is given its arguments. "told" is when the
first final failed criterion comes, "whole" when the check has ended; half of the checks stay within p50, nine of ten
within p90. "times sol." is the median of the submissions relative to the solution's time; "within" is the share of them
that end within twice the solution's time plus 4 s. CPU is in seconds per check: of the engine, and of its children.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import csv
import json
import os
import statistics
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tests.judging import find_cases
from tests.sampling import sample
from tutor.content import load_course
from tutor.content.submissions import RIGHT, WRONG
from tutor.engine.loading import load_check
from tutor.judge.events import CriterionJudged, ExerciseJudged, decode
from tutor.judge.verdict import Status
from tutor.process.process_table import descendants

LIMIT_S = 180.0
QUIET_S = 0.3

# Only the engine's own process can tell its CPU time from that of its children, so it prints both.
PROGRAM = """
import json, resource, sys
from tutor.engine.__main__ import main
code = main()
used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
print(json.dumps([each.ru_utime + each.ru_stime for each in used]), file=sys.stderr)
sys.exit(code)
"""


@dataclass(frozen=True)
class Timing:
    """One check: its wall-clock and CPU times, in seconds. `told_s` is None if no criterion failed."""

    name: str
    exercise: str
    kind: str
    verdict: str
    told_s: float | None
    whole_s: float
    ours_s: float
    started_s: float


async def time_check(name: str, exercise: str, kind: str, folder: Path, *, ready: bool) -> Timing:
    """Check the files in a folder. Raises SystemExit if there is no verdict."""
    arguments = [exercise, str(folder)]
    began = time.perf_counter()
    process = await asyncio.create_subprocess_exec(
        *(sys.executable, "-c", PROGRAM, *(["--standby"] if ready else arguments)),
        stdin=asyncio.subprocess.PIPE,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
        limit=2**24,
    )
    assert process.stdin is not None
    assert process.stdout is not None
    assert process.stderr is not None
    if ready:
        await _wait_until_prepared(process.pid)
        began = time.perf_counter()
        process.stdin.write(json.dumps(arguments).encode() + b"\n")
    stderr = asyncio.ensure_future(process.stderr.read())
    told_s, verdict = None, ""
    try:
        async with asyncio.timeout(LIMIT_S):
            async for line in process.stdout:
                event = decode(line.decode())
                if isinstance(event, CriterionJudged) and told_s is None:
                    failed = event.result.verdict.status is Status.FAILED and not event.result.bonus
                    told_s = time.perf_counter() - began if failed else None
                elif isinstance(event, ExerciseJudged):
                    verdict = event.result.verdict.value
            await process.wait()
    finally:
        if process.returncode is None:
            process.terminate()
            await process.wait()
    whole_s, errors = time.perf_counter() - began, (await stderr).decode()
    if not verdict:
        raise SystemExit(f"{name} was not judged:\n{errors}")
    ours_s, started_s = json.loads(errors.splitlines()[-1])
    return Timing(name, exercise, kind, verdict, told_s, whole_s, ours_s, started_s)


async def _wait_until_prepared(engine: int) -> None:
    """Wait until an engine and its fork server have used no CPU time for `QUIET_S`."""
    used, since = -1, time.monotonic()
    while time.monotonic() < since + QUIET_S:
        await asyncio.sleep(0.02)
        pids = [engine, *(each.pid for each in descendants(engine))]
        with contextlib.suppress(OSError):  # one of them has just ended
            fields = [Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split() for pid in pids]
            if len(pids) < 2 or used != (used := sum(int(field[11]) + int(field[12]) for field in fields)):
                since = time.monotonic()


async def time_all(wanted: Sequence[tuple[str, str, str, Path]], jobs: int, *, ready: bool) -> list[Timing]:
    """Check all, `jobs` at a time; report each on stderr."""
    slots, timings = asyncio.Semaphore(jobs), []

    async def check_one(name: str, exercise: str, kind: str, folder: Path) -> None:
        async with slots:
            each = await time_check(name, exercise, kind, folder, ready=ready)
        timings.append(each)
        told = f"{each.told_s:6.2f}" if each.told_s is not None else "      "
        print(f"{len(timings):>5}/{len(wanted)} {told} {each.whole_s:6.2f} s  {name}", file=sys.stderr, flush=True)

    async with asyncio.TaskGroup() as tasks:
        for each in wanted:
            tasks.create_task(check_one(*each))
    return timings


def quantile(values: Sequence[float], share: float) -> float:
    """Return the value that this share (0 to 1) of the values stays within; NaN if there are none."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))] if ordered else float("nan")


def format_row(name: str, timings: Sequence[Timing], solution_s: float | None) -> str:
    """Format the figures of some checks. `solution_s` is the duration of the solution's check."""
    told = [each.told_s for each in timings if each.told_s is not None]
    whole = [each.whole_s for each in timings]
    shares = ""
    if solution_s is not None and whole:
        within = sum(each <= 2 * solution_s + 4 for each in whole) / len(whole)
        shares = f"{quantile(whole, 0.5) / solution_s:>8.2f}{within:>9.0%}"
    cpu = f"{statistics.mean(t.ours_s for t in timings):>7.2f}{statistics.mean(t.started_s for t in timings):>9.2f}"
    figures = "".join(f"{quantile(times, share):>7.2f}" for times in (told, whole) for share in (0.5, 0.9, 1.0))
    return f"{name:<16}{len(timings):>5}{figures}{cpu}{shares}"


def main() -> int:
    """Print a line for each exercise's solution, wrong and right submissions, and one for each kind in total."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wanted", nargs="*")
    parser.add_argument("--sample", action="store_true", help="only the submissions that the tests judge")
    parser.add_argument("--ready", action="store_true", help="by engines that have prepared themselves, as in the app")
    parser.add_argument("--jobs", type=int, default=2, help="submissions checked in parallel")
    parser.add_argument("--times", type=int, default=1, help="check each submission this many times")
    parser.add_argument("--solution-times", type=int, default=3, help="check each solution this many times, alone")
    parser.add_argument("--csv", type=Path, help="also write every check to this file")
    arguments = parser.parse_args()
    cases = find_cases(arguments.wanted)[0]
    cases = [case for case in (sample(cases) if arguments.sample else cases) if case.kind in (WRONG, RIGHT)]
    if not cases:
        parser.error("no wrong or right submission has this name")
    lessons = [lesson for lesson in load_course().lessons if any(case.exercise == lesson.id for case in cases)]
    print(f"{len(os.sched_getaffinity(0))} cores, load {os.getloadavg()[0]:.1f}; seconds")
    print(f"{'':<16}{'':>5}{'told':>7}{'':>14}{'whole':>7}{'':>14}{'CPU':>7}{'':>9}{'times':>8}")
    heads = "".join(f"{head:>7}" for head in ("p50", "p90", "max") * 2)
    print(f"{'':<16}{'n':>5}{heads}{'ours':>7}{'started':>9}{'sol.':>8}{'within':>9}")
    timings: list[Timing] = []
    solution_s: dict[str, float] = {}
    for lesson in lessons:
        folder = lesson.folder / "solution"
        own = [(f"{lesson.id} solution", lesson.id, "solution", folder)] * arguments.solution_times
        solutions = asyncio.run(time_all(own, 1, ready=arguments.ready))
        solution_s[lesson.id] = statistics.median(each.whole_s for each in solutions)
        check = load_check(lesson)
        floor = f"  of which {check.expected_s:.1f} for {check.expected_reason}"
        print(format_row(f"{lesson.id} solution", solutions, None) + floor, flush=True)
        timings += solutions
    for kind in (WRONG, RIGHT):
        for lesson in lessons:
            mine = [case for case in cases if case.exercise == lesson.id and case.kind == kind]
            if mine:
                wanted = [(str(case), lesson.id, kind, case.folder) for case in mine] * arguments.times
                found = asyncio.run(time_all(wanted, arguments.jobs, ready=arguments.ready))
                print(format_row(f"{lesson.id} {kind}", found, solution_s[lesson.id]), flush=True)
                timings += found
        if found := [each for each in timings if each.kind == kind]:
            print(format_row(f"all {kind}", found, None), flush=True)
    if arguments.csv:
        with arguments.csv.open("w", newline="") as file:
            writer = csv.writer(file)
            names = list(Timing.__dataclass_fields__)
            writer.writerows([names, *([getattr(each, name) for name in names] for each in timings)])
    return 0


if __name__ == "__main__":
    sys.exit(main())
