"""Judge every submission under tests/submissions and compare with what its expect.yaml says.

    uv run python -m tests.soundness [EXERCISE[/right|wrong[/NAME]] ...] [--times N] [--jobs N]

prints each verdict that is not as expected, then a table: for each exercise how many right and wrong submissions were
judged right, and the false passes and false failures.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import sys
import time
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from tutor.judge.events import ExerciseJudged, decode
from tutor.judge.result import ExerciseResult
from tutor.judge.verdict import Status

ROOT = Path(__file__).parent / "submissions"
LIMIT_S = 180.0


@dataclass(frozen=True)
class Case:
    """One submission folder and what it must be judged as."""

    exercise: str
    kind: str
    folder: Path
    expect: Mapping[str, Any]

    def __str__(self) -> str:
        return f"{self.exercise}/{self.kind}/{self.folder.name}"


@dataclass
class Outcome:
    """What one run of one case gave. `wrong` says in words what is not as expected; empty where all is."""

    case: Case
    wrong: list[str] = field(default_factory=list)
    false_pass: bool = False
    false_failure: bool = False
    took_s: float = 0.0


def cases(wanted: Sequence[str] = ()) -> list[Case]:
    """The cases whose name begins with one of `wanted` (all, without any)."""
    found = [
        Case(path.parts[-4].replace("_", "."), path.parts[-3], path.parent, yaml.safe_load(path.read_text()))
        for path in sorted(ROOT.glob("*/*/*/expect.yaml"))
    ]
    return [case for case in found if not wanted or any(str(case).startswith(each) for each in wanted)]


async def judge(case: Case) -> Outcome:
    """Check the submission as the terminal app does, in a process of its own, and compare."""
    started = time.monotonic()
    process = await asyncio.create_subprocess_exec(
        sys.executable,
        "-m",
        "tutor.engine",
        case.exercise,
        str(case.folder),
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
        stdin=asyncio.subprocess.DEVNULL,
        limit=2**24,
    )
    try:
        out, err = await asyncio.wait_for(process.communicate(), LIMIT_S)
    except TimeoutError:
        process.terminate()
        out, err = await process.communicate()
        return Outcome(case, [f"no verdict in {LIMIT_S:g} s"], took_s=LIMIT_S)
    results = [e.result for e in map(decode, out.decode().splitlines()) if isinstance(e, ExerciseJudged)]
    took = time.monotonic() - started
    if not results:
        return Outcome(case, [f"no verdict: exit code {process.returncode}: {err.decode()[-500:]}"], took_s=took)
    outcome = compare(case, results[0])
    outcome.took_s = took
    if err:
        outcome.wrong.append(f"stderr: {err.decode()[-300:]}")
    outcome.wrong += [f"left behind: {line}" for line in _left(case.expect.get("gone", ""))]
    return outcome


def compare(case: Case, result: ExerciseResult) -> Outcome:
    """Hold the result against expect.yaml (see tests/submissions/README.md)."""
    expect = case.expect
    fails, any_of = set(expect.get("fails", ())), set(expect.get("fails_any", ()))
    bonus_failed, either = set(expect.get("bonus_failed", ())), set(expect.get("either", ()))
    not_passed = set(expect.get("not_passed", ()))
    outcome = Outcome(case)
    some_failed = any(c.verdict.status is Status.FAILED for c in result.criteria)
    for criterion in result.criteria:
        status, cause = criterion.verdict.status, criterion.verdict.cause
        told = f"{criterion.id} {status.value}: {criterion.verdict.observed} | {cause}"
        if status is Status.ERROR:
            outcome.wrong.append(told)
        elif criterion.id in fails | bonus_failed:
            if status is not Status.FAILED:
                outcome.wrong.append(f"should fail: {told}")
                outcome.false_pass |= status is Status.PASSED
            else:
                outcome.wrong += _wrong_cause(expect.get("cause"), criterion.id, cause, criterion.id in fails)
        elif criterion.id in any_of:
            if status is Status.FAILED:
                outcome.wrong += _wrong_cause(expect.get("cause"), criterion.id, cause, True)
        elif criterion.id in not_passed:
            if status is Status.PASSED:
                outcome.wrong.append(f"should not pass: {told}")
                outcome.false_pass = True
        elif criterion.id not in either and (status is Status.FAILED or (status is Status.SKIPPED and not some_failed)):
            outcome.wrong.append(f"should pass: {told}")
            outcome.false_failure = True
    if any_of and not any(c.id in any_of and c.verdict.status is Status.FAILED for c in result.criteria):
        outcome.wrong.append(f"one of {', '.join(sorted(any_of))} should fail")
        outcome.false_pass = True
    return outcome


def _wrong_cause(wanted: Any, criterion: str, cause: str, required: bool) -> list[str]:
    if isinstance(wanted, Mapping):
        wanted = wanted.get(criterion)
    elif not required:
        wanted = None
    texts = [wanted] if isinstance(wanted, str) else list(wanted or ())
    if not texts or any(str(text).casefold() in cause.casefold() for text in texts):
        return []
    return [f"{criterion}: cause is “{cause}”, not {' or '.join(map(str, texts))}"]


def _left(text: str) -> list[str]:
    if not text:
        return []
    commands = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            commands.append(path.read_bytes().replace(b"\0", b" ").decode(errors="replace"))
        except OSError:
            continue
    return [command for command in commands if text in command]


async def judge_all(chosen: Iterable[Case], jobs: int) -> list[Outcome]:
    """Judge the cases, `jobs` at a time, telling of each that is not as expected."""
    free = asyncio.Semaphore(jobs)

    async def one(case: Case) -> Outcome:
        async with free:
            outcome = await judge(case)
        mark = "  " if not outcome.wrong else "! "
        print(f"{mark}{outcome.took_s:6.1f} s  {case}", *outcome.wrong, sep="\n        ", flush=True)
        return outcome

    return list(await asyncio.gather(*(one(case) for case in chosen)))


def table(outcomes: Sequence[Outcome]) -> str:
    """One line for each exercise and kind."""
    lines = [
        f"{'exercise':<10}{'kind':<8}{'submissions':>12}{'runs':>6}{'as expected':>13}"
        f"{'false passes':>14}{'false failures':>16}"
    ]
    for exercise, kind in sorted({(o.case.exercise, o.case.kind) for o in outcomes}):
        mine = [o for o in outcomes if (o.case.exercise, o.case.kind) == (exercise, kind)]
        count = Counter(
            as_expected=sum(not o.wrong for o in mine),
            false_pass=sum(o.false_pass for o in mine),
            false_failure=sum(o.false_failure for o in mine),
        )
        lines.append(
            f"{exercise:<10}{kind:<8}{len({str(o.case) for o in mine}):>12}{len(mine):>6}{count['as_expected']:>13}"
            f"{count['false_pass']:>14}{count['false_failure']:>16}"
        )
    return "\n".join(lines)


def main() -> int:
    """Exit code 0 where every verdict is as expected, else 1."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wanted", nargs="*")
    parser.add_argument("--times", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=3)
    parser.add_argument("--json", action="store_true", help="print the wrong ones as JSON, too")
    arguments = parser.parse_args()
    chosen = cases(arguments.wanted) * arguments.times
    outcomes = asyncio.run(judge_all(chosen, arguments.jobs))
    if arguments.json:
        print(json.dumps([{"case": str(o.case), "wrong": o.wrong} for o in outcomes if o.wrong]))
    print(table(outcomes))
    return 1 if any(o.wrong for o in outcomes) or not outcomes else 0


if __name__ == "__main__":
    sys.exit(main())
