"""Follow the next steps of failing checks literally, as a beginner would, and see whether they lead on.

    uv run python -m tests.repairs [EXERCISE[/wrong[/NAME]] | FOLDER ...] [--jobs N] [--steps N] [--every N]

For each wrong submission: the next step of the first failed required criterion is done word for word in a copy, which
is checked again, two times at most. stdout has a row for each submission whose first failed criterion does not pass
then, with the step that did not help, and a table at the end. A step that has no code to be put anywhere is one "in
words": it may help a person, and is not followed. FOLDER has submissions that are called like i1_2_anything.
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

from tests.judging import check_folder, find
from tutor.content.submissions import WRONG
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.step_parsing import NotAnEdit, apply_step
from tutor.judge.verdict import Status

__all__ = ["NotAnEdit", "apply_step", "repair_all", "table"]


@dataclass
class Repair:
    """How a submission fared: its first failed criterion, the steps followed, and how many of them made it pass."""

    name: str
    criterion: str = ""
    steps: list[str] = field(default_factory=list)
    fixed_after: int | None = None
    in_words: bool = False
    trouble: str = ""


async def repair(name: str, exercise: str, folder: Path, most: int) -> Repair:
    """Check the submission, and follow the next step of its first failed criterion, `most` times."""
    told = Repair(name)
    with tempfile.TemporaryDirectory(prefix="repair-") as temporary:
        copy = Path(shutil.copytree(folder, Path(temporary) / "submission"))
        for turn in range(most + 1):
            result = await check_folder(exercise, copy)
            failed = _first_failed(result)
            if failed is None and not told.criterion:
                told.trouble = "nothing required fails"
                return told
            told.criterion = told.criterion or (failed.id if failed else "")
            if failed is None or _passes(result, told.criterion):
                told.fixed_after = turn
                return told
            if turn == most:
                return told
            told.steps.append(failed.verdict.hint)
            files = {file.name: file.read_text(errors="replace") for file in sorted(copy.glob("*.py"))}
            try:
                for file, text in apply_step(failed.verdict.hint, files).items():
                    (copy / file).write_text(text)
            except NotAnEdit:
                told.in_words = True
                return told
    return told


def _first_failed(result: ExerciseResult) -> CriterionResult | None:
    return next((c for c in result.criteria if not c.bonus and c.verdict.status is Status.FAILED), None)


def _passes(result: ExerciseResult, criterion: str) -> bool:
    return any(c.id == criterion and c.verdict.status is Status.PASSED for c in result.criteria)


async def repair_all(chosen: Sequence[tuple[str, str, Path]], jobs: int, most: int) -> list[Repair]:
    """Follow the steps of each, `jobs` at a time, telling of each on stderr."""
    free = asyncio.Semaphore(jobs)
    done: list[Repair] = []

    async def one(name: str, exercise: str, folder: Path) -> None:
        async with free:
            try:
                found = await repair(name, exercise, folder, most)
            except Exception as error:  # told in the table; the others go on
                found = Repair(name, trouble=repr(error))
        done.append(found)
        print(f"{len(done)}/{len(chosen)} {name} {_outcome(found)}", file=sys.stderr, flush=True)

    await asyncio.gather(*(one(*each) for each in chosen))
    return sorted(done, key=lambda each: each.name)


def _outcome(each: Repair) -> str:
    if each.trouble:
        return each.trouble
    if each.fixed_after is not None:
        return f"fixed after {each.fixed_after}"
    return "in words" if each.in_words else "not fixed"


def table(done: Sequence[Repair]) -> str:
    """How many of each exercise pass after one step and after two, have steps in words, and are not fixed."""
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
                *(str(sum(_outcome(each) == outcome for each in some)) for outcome in ("in words", "not fixed")),
                str(sum(bool(each.trouble) for each in some)),
            )
        )
    return "\n".join("  ".join(f"{cell:>12}" for cell in row) for row in rows)


def main() -> int:
    """Exit code 0, whatever was fixed; 2 where there is nothing to follow."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wanted", nargs="*")
    parser.add_argument("--jobs", type=int, default=2, help="this many at a time")
    parser.add_argument("--steps", type=int, default=2, help="follow this many steps, one after another")
    parser.add_argument("--every", type=int, default=1, help="take each Nth submission only")
    arguments = parser.parse_args()
    folders = [Path(each) for each in arguments.wanted if Path(each).is_dir()]
    names = [each for each in arguments.wanted if not Path(each).is_dir()]
    cases = [] if folders and not names else find(names)[0]
    chosen = [(str(case), case.exercise, case.folder) for case in cases if case.kind == WRONG]
    for folder in folders:
        each_of = [folder] if re.match(r"i\d_\d_", folder.name) else sorted(folder.glob("i?_?_*"))
        chosen += [(each.name, each.name[:4].replace("_", "."), each) for each in each_of]
    chosen = chosen[:: arguments.every]
    if not chosen:
        print("no submission is called so", file=sys.stderr)
        return 2
    done = asyncio.run(repair_all(chosen, arguments.jobs, arguments.steps))
    for each in done:
        if each.fixed_after is None:
            steps = "".join("\n    " + step.replace("\n", "\n    ") + "\n    --" for step in each.steps)
            print(f"{_outcome(each)}: {each.name} {each.criterion}{steps}")
    print(table(done))
    return 0


if __name__ == "__main__":
    sys.exit(main())
