"""Follow the next steps of failing checks literally, as a beginner would, and see whether they lead to a pass.

    uv run python -m tests.repairs [EXERCISE[/wrong[/NAME]] | FOLDER ...] [--jobs N] [--steps N] [--every N]

For each wrong submission, the next step of the first failed required criterion is applied word for word to a copy,
which is checked again, at most twice. stdout has a row for each submission whose first failed criterion still does not
pass, with the steps that did not help, and a table at the end. A step without code to insert is "in words": it may help
a person, but is not followed. FOLDER has submissions with names like i1_2_anything.
"""

from __future__ import annotations

import argparse
import asyncio
import re
import shutil
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tests.judging import check_folder, find_cases
from tutor.content.submissions import WRONG
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.step_parsing import NotAnEdit, apply_step
from tutor.judge.verdict import Status

__all__ = ["NotAnEdit", "apply_step", "repair_all", "table"]


@dataclass
class Repair:
    """The outcome for a submission: its first failed criterion, the steps followed, and how many made it pass."""

    name: str
    criterion: str = ""
    steps: list[str] = field(default_factory=list)
    fixed_after: int | None = None
    in_words: bool = False
    trouble: str = ""


async def repair(name: str, exercise: str, folder: Path, max_steps: int) -> Repair:
    """Check the submission, and follow the next step of its first failed criterion, up to `max_steps` times."""
    outcome = Repair(name)
    with tempfile.TemporaryDirectory(prefix="repair-") as temporary:
        copy = Path(shutil.copytree(folder, Path(temporary) / "submission"))
        for turn in range(max_steps + 1):
            result = await check_folder(exercise, copy)
            failed = _first_failed(result)
            if failed is None and not outcome.criterion:
                outcome.trouble = "nothing required fails"
                return outcome
            outcome.criterion = outcome.criterion or (failed.id if failed else "")
            if failed is None or _passes(result, outcome.criterion):
                outcome.fixed_after = turn
                return outcome
            if turn == max_steps:
                return outcome
            outcome.steps.append(failed.verdict.hint)
            files = {file.name: file.read_text(errors="replace") for file in sorted(copy.glob("*.py"))}
            try:
                for file, text in apply_step(failed.verdict.hint, files).items():
                    (copy / file).write_text(text)
            except NotAnEdit:
                outcome.in_words = True
                return outcome
    return outcome


def _first_failed(result: ExerciseResult) -> CriterionResult | None:
    return next((c for c in result.criteria if not c.bonus and c.verdict.status is Status.FAILED), None)


def _passes(result: ExerciseResult, criterion: str) -> bool:
    return any(c.id == criterion and c.verdict.status is Status.PASSED for c in result.criteria)


async def repair_all(chosen: Sequence[tuple[str, str, Path]], jobs: int, max_steps: int) -> list[Repair]:
    """Follow the steps of each submission, `jobs` at a time, reporting each on stderr."""
    slots = asyncio.Semaphore(jobs)
    done: list[Repair] = []

    async def repair_one(name: str, exercise: str, folder: Path) -> None:
        async with slots:
            try:
                found = await repair(name, exercise, folder, max_steps)
            except Exception as error:  # counted in the table; the others continue
                found = Repair(name, trouble=repr(error))
        done.append(found)
        print(f"{len(done)}/{len(chosen)} {name} {_describe(found)}", file=sys.stderr, flush=True)

    await asyncio.gather(*(repair_one(*each) for each in chosen))
    return sorted(done, key=lambda each: each.name)


def _describe(each: Repair) -> str:
    if each.trouble:
        return each.trouble
    if each.fixed_after is not None:
        return f"fixed after {each.fixed_after}"
    return "in words" if each.in_words else "not fixed"


def table(done: Sequence[Repair]) -> str:
    """Count, for each exercise, the submissions fixed after one or two steps, with steps in words, and not fixed."""
    rows: list[tuple[str, ...]] = [
        ("exercise", "submissions", "after one", "after two", "in words", "not fixed", "not followed")
    ]
    for exercise in (*sorted({each.name[:4] for each in done}), ""):
        some = [each for each in done if each.name.startswith(exercise)]
        rows.append(
            (
                exercise or "all",
                str(len(some)),
                str(sum(each.fixed_after == 1 for each in some)),
                str(sum(each.fixed_after in (1, 2) for each in some)),
                *(str(sum(_describe(each) == outcome for each in some)) for outcome in ("in words", "not fixed")),
                str(sum(bool(each.trouble) for each in some)),
            )
        )
    return "\n".join("  ".join(f"{cell:>12}" for cell in row) for row in rows)


def main() -> int:
    """Return exit code 0 whatever was fixed, 2 if no submission matches."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wanted", nargs="*")
    parser.add_argument("--jobs", type=int, default=2, help="submissions checked in parallel")
    parser.add_argument("--steps", type=int, default=2, help="follow at most this many steps, one after another")
    parser.add_argument("--every", type=int, default=1, help="take only every Nth submission")
    arguments = parser.parse_args()
    folders = [Path(each) for each in arguments.wanted if Path(each).is_dir()]
    names = [each for each in arguments.wanted if not Path(each).is_dir()]
    cases = [] if folders and not names else find_cases(names)[0]
    chosen = [(str(case), case.exercise, case.folder) for case in cases if case.kind == WRONG]
    for folder in folders:
        submissions = [folder] if re.match(r"i\d_\d_", folder.name) else sorted(folder.glob("i?_?_*"))
        chosen += [(each.name, each.name[:4].replace("_", "."), each) for each in submissions]
    chosen = chosen[:: arguments.every]
    if not chosen:
        print("no submission has this name", file=sys.stderr)
        return 2
    done = asyncio.run(repair_all(chosen, arguments.jobs, arguments.steps))
    for each in done:
        if each.fixed_after is None:
            steps = "".join("\n    " + step.replace("\n", "\n    ") + "\n    --" for step in each.steps)
            print(f"{_describe(each)}: {each.name} {each.criterion}{steps}")
    print(table(done))
    return 0


if __name__ == "__main__":
    sys.exit(main())
