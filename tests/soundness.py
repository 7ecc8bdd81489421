"""Judge every submission under tests/submissions and compare with what its expect.yaml says.

    uv run python -m tests.soundness [EXERCISE[/right|wrong[/NAME]] ...] [--changed] [--every N] [--times N] [--jobs N]
                                     [--busy] [--sameness] [--record FOLDER]

`--changed` judges the submissions that differ from the branch main, all of an exercise whose check differs, and the
tests' sample if code that all checks share differs. `--every 5` judges a fifth of those chosen.

With `--sameness`, expectations do not count: each submission is judged ten times (or `--times`), in turn as the app
does, on the command line, by one criterion alone and with `--first`, and each criterion whose status varies is listed.

Reports each run on stderr. At the end, stdout has each verdict that is not as expected, the submissions whose verdict
varies, and a table: for each exercise how many right and wrong ones were judged as expected, the false passes and false
failures, and how long a verdict took.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import signal
import statistics
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from tests import sameness
from tests.judging import Outcome, find_cases, holds_here, judge
from tests.sampling import changed
from tutor.content import load_course
from tutor.content.submissions import Case

# A busy loop that ends when its owner is gone. The owner may be killed before the loop's first instruction, so its pid
# is an argument rather than os.getppid(). A time limit ends the loop should that ever go wrong.
BUSY_LOOP = """
import os, sys, time
owner, until = int(sys.argv[1]), time.monotonic() + float(sys.argv[2])
while os.getppid() == owner and time.monotonic() < until:
    for _ in range(100_000): pass
"""
BUSY_LIMIT_S = 6 * 3600.0
COLUMNS = ("exercise", "kind", "submissions", "runs", "as expected", "false passes", "false failures", "not judged")
SAMENESS_TIMES = 10
TIMES = ("min s", "median", "max s")


async def judge_all(chosen: Sequence[Case], jobs: int, record: Path | None = None) -> list[Outcome]:
    """Judge the cases, `jobs` at a time, reporting each on stderr. On SIGINT or SIGTERM, return the outcomes so far.

    `record`: a folder for recordings of the checks.
    """
    slots = asyncio.Semaphore(jobs)
    outcomes: list[Outcome] = []

    async def judge_one(case: Case) -> None:
        async with slots:
            outcome = await judge(case, record=record)
        outcomes.append(outcome)
        mark = "! " if outcome.wrong else "  "
        count = f"{len(outcomes)}/{len(chosen)}"
        lines = [f"{mark}{count:>9}{outcome.took_s:7.1f} s  {case}", *outcome.wrong]
        print("\n        ".join(lines), file=sys.stderr, flush=True)

    tasks = [asyncio.ensure_future(judge_one(case)) for case in chosen]
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, lambda: [task.cancel() for task in tasks])
    for ended in await asyncio.gather(*tasks, return_exceptions=True):
        if isinstance(ended, Exception):
            raise ended
    return outcomes


@contextmanager
def busy_cores(count: int) -> Iterator[None]:
    """Keep this many cores busy, at normal priority."""
    command = [sys.executable, "-I", "-S", "-c", BUSY_LOOP, str(os.getpid()), str(BUSY_LIMIT_S)]
    loops = [subprocess.Popen(command) for _ in range(count)]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
        for loop in loops:
            loop.wait()


def table(outcomes: Sequence[Outcome]) -> str:
    """Format one line for each exercise and kind, and one for all."""
    groups = sorted({(o.case.exercise, o.case.kind) for o in outcomes})
    rows = [(*group, *_figures([o for o in outcomes if (o.case.exercise, o.case.kind) == group])) for group in groups]
    rows.append(("all", "", *_figures(outcomes)))
    heads = (*COLUMNS, *TIMES)
    widths = [max(len(head), *(len(row[place]) for row in rows)) for place, head in enumerate(heads)]
    lines = []
    for row in (heads, *rows):
        cells = [
            f"{cell:<{width}}" if place < 2 else f"{cell:>{width}}"
            for place, (cell, width) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append("  ".join(cells).rstrip())
    return "\n".join(lines)


def _figures(outcomes: Sequence[Outcome]) -> tuple[str, ...]:
    took = [outcome.took_s for outcome in outcomes] or [0.0]
    counts = (
        len({str(outcome.case) for outcome in outcomes}),
        len(outcomes),
        sum(not outcome.wrong for outcome in outcomes),
        sum(outcome.false_pass for outcome in outcomes),
        sum(outcome.false_failure for outcome in outcomes),
        sum(any(text.startswith(("not judged", "no verdict")) for text in outcome.wrong) for outcome in outcomes),
    )
    return (*map(str, counts), *(f"{value:.1f}" for value in (min(took), statistics.median(took), max(took))))


def flaky(outcomes: Sequence[Outcome]) -> list[str]:
    """List the submissions whose verdict varied, each with what differed and how often it occurred."""
    lines = []
    for name in sorted({str(outcome.case) for outcome in outcomes}):
        verdicts = Counter(outcome.verdict for outcome in outcomes if str(outcome.case) == name)
        if len(verdicts) > 1:
            every = [set(verdict.split()) for verdict in verdicts]
            same = set.intersection(*every)
            lines.append(f"{name}:")
            for verdict, times in verdicts.most_common():
                differs = " ".join(word for word in verdict.split() if word not in same)
                lines.append(f"    {times} times {differs or 'without the others'}")
    return lines


def _find_changed_paths() -> list[str]:
    """Return the files that differ from the branch main, and the untracked ones."""
    git = ("git", "-C", os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    differing = subprocess.check_output([*git, "diff", "--name-only", "--merge-base", "main"], text=True)
    untracked = subprocess.check_output([*git, "ls-files", "--others", "--exclude-standard"], text=True)
    return [*differing.splitlines(), *untracked.splitlines()]


def _compare_runs(cases: Sequence[Case], times: int, jobs: int) -> int:
    """Print each criterion whose status varies; return exit code 1 if there is one."""
    criteria = {lesson.id: [each.id for each in lesson.criteria] for lesson in load_course().lessons}
    runs = asyncio.run(sameness.judge_again_and_again(cases, times, jobs, criteria))
    lines = sameness.variations(runs)
    print(*lines, sep="\n")
    print(f"{len(cases)} submissions, {len(runs)} runs: {len(lines) or 'no'} differences")
    return 1 if lines else 0


def main() -> int:
    """Return exit code 0 if every verdict is as expected, 1 if not, 2 if there is nothing to judge."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wanted", nargs="*")
    parser.add_argument("--times", type=int, help="judge each submission this many times")
    parser.add_argument("--jobs", type=int, default=3, help="submissions judged in parallel")
    parser.add_argument("--changed", action="store_true", help="only what a difference from main may affect")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="only every Nth of the chosen submissions")
    parser.add_argument("--sameness", action="store_true", help="list each criterion whose status varies between runs")
    parser.add_argument("--busy", action="store_true", help="run a busy loop on each core meanwhile")
    parser.add_argument("--record", type=Path, metavar="FOLDER", help="also record what the judges got (see replay)")
    parser.add_argument("--json", action="store_true", help="also print the wrong ones as JSON")
    arguments = parser.parse_args()
    found, broken = find_cases(arguments.wanted)
    for error in broken:
        print(f"! {error}", file=sys.stderr)
    here = [case for case in found if holds_here(case)]
    if len(here) < len(found):
        print(f"{len(found) - len(here)} are skipped: they are about another ROS than this", file=sys.stderr)
    if arguments.changed:
        here = changed(here, _find_changed_paths())
        if not here:
            print("no difference from main affects a submission", file=sys.stderr)
            return 0
    if not here:
        print(f"no submission is named {' or '.join(arguments.wanted) or 'anything'}", file=sys.stderr)
        return 2
    here = here[:: arguments.every]
    times = arguments.times or (SAMENESS_TIMES if arguments.sameness else 1)
    with busy_cores(len(os.sched_getaffinity(0)) if arguments.busy else 0):
        if arguments.sameness:
            return _compare_runs(here, times, arguments.jobs)
        outcomes = asyncio.run(judge_all(here * times, arguments.jobs, arguments.record))
    wrong = [outcome for outcome in outcomes if outcome.wrong]
    if arguments.json:
        print(json.dumps([{"case": str(o.case), "wrong": o.wrong} for o in wrong]))
    for outcome in wrong:
        print(f"not as expected: {outcome.case}", *outcome.wrong, sep="\n        ")
    if lines := flaky(outcomes):
        print("not the same each time:", *lines, sep="\n    ")
    print(table(outcomes))
    complete = len(outcomes) == len(here) * times
    if not complete:
        print(f"interrupted: {len(outcomes)} of {len(here) * times} runs", file=sys.stderr)
    return 1 if wrong or broken or not complete else 0


if __name__ == "__main__":
    sys.exit(main())
