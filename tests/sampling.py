"""Which submissions the tests judge: enough to show each criterion kept and broken, and each mistake of the contract.

`python -m tests.soundness` judges all of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from tutor.content.submissions import RIGHT, WRONG, Case

SHARED_CODE = tuple(f"tutor/{package}/" for package in ("engine", "exercise", "judge", "process", "ros", "bundled_ros"))
ROOT = Path(__file__).parents[1]
MISTAKES = (
    "wrong topic",
    "wrong type",
    "incompatible QoS",
    "no spin",
    "exit at once",
    "syntax error",
    "import error",
    "unhandled exception",
    "integer parameter",
    "callback returns None",
    "timer not replaced",
    "old timer kept",
    "rate used as a period",
    "blocked executor",
    "deadlock by call()",
    "float in an int field",
    "output held back by buffering",
    "SIGINT ignored",
    "second node of the same name",
)
"""The mistakes that the contract lists: a check recognises each, under this name."""

_NAMES = frozenset(name.casefold() for name in MISTAKES)


def sample(cases: Sequence[Case]) -> list[Case]:
    """Return a right submission of each exercise, and enough wrong ones to show its criteria and each cause.

    One right one is enough here, as `ros-tutor author check` judges the solutions. The choice does not depend on the
    order of `cases`: it goes by name, and takes those that show most first.
    """
    right = [_middle(group) for group in _right_by_exercise(cases).values()]
    wrong = sorted((case for case in cases if case.kind == WRONG), key=str)
    chosen: list[Case] = []
    missing = set().union(*map(shows, wrong))
    while missing:
        best = max(wrong, key=lambda case: len(shows(case) & missing))
        chosen.append(best)
        wrong.remove(best)
        missing -= shows(best)
    return [case for case in cases if case in right or case in chosen]


def changed(cases: Sequence[Case], paths: Iterable[str]) -> list[Case]:
    """Return the cases that a change of these files (relative to the clone) may affect.

    These are the cases whose own files (or the targets of whose symlinks) changed, all cases of an exercise whose
    check, skeleton or solution changed, and the sample if code that all checks share changed.
    """
    folders = {"/".join(Path(path).parts[:5]) for path in paths if path.startswith("tests/submissions/")}
    files = {(ROOT / path).resolve() for path in paths}
    own_code = [Path(path).parts[1] for path in paths if path.startswith(("checks/", "lessons/"))]
    shared = any(path.startswith(SHARED_CODE) for path in paths)
    chosen = sample(cases) if shared else []

    def is_affected(case: Case) -> bool:
        exercise = case.exercise.replace(".", "_")
        own = f"tests/submissions/{exercise}/{case.kind}/{case.folder.name}" in folders
        changed_code = any(f"{Path(name).stem}_".startswith(f"{exercise}_") for name in own_code)
        return changed_code or own or any(link.resolve() in files for link in _symlinks(case.folder))

    return [case for case in cases if case in chosen or is_affected(case)]


def judged_criteria(case: Case, first: str) -> tuple[str, ...]:
    """Return the criteria by which the tests judge a submission, in alphabetical order; () for all.

    A right one is judged by all, the others by what they break; a hostile one that breaks nothing by `first`, the
    exercise's first criterion, as each start of it does the same to us.
    """
    expected = case.expected
    broken = {*expected.fails, *expected.fails_any, *expected.bonus_failed}
    return () if case.kind == RIGHT else tuple(sorted(broken)) or (first,)


def shows(case: Case) -> frozenset[tuple[str, str]]:
    """Return what a wrong submission shows: (exercise, criterion) for what it breaks, ("mistake", name) for why.

    Only those in `MISTAKES` count; the others have a page, which is their test.
    """
    expected = case.expected
    broken = {(case.exercise, criterion) for criterion in (*expected.fails, *expected.bonus_failed)}
    return frozenset(broken | {("mistake", name) for name in _main_causes(expected.causes.values()) if name in _NAMES})


def _right_by_exercise(cases: Iterable[Case]) -> dict[str, list[Case]]:
    found: dict[str, list[Case]] = {}
    for case in sorted(cases, key=str):
        if case.kind == RIGHT:
            found.setdefault(case.exercise, []).append(case)
    return found


def _middle(cases: Sequence[Case]) -> Case:
    return cases[len(cases) // 2]


def _symlinks(folder: Path) -> list[Path]:
    return [path for path in folder.rglob("*") if path.is_symlink()]


def _main_causes(causes: Iterable[Sequence[str]]) -> list[str]:
    # Of several acceptable causes, the first is the one that the submission's author had in mind.
    return [texts[0].casefold() for texts in causes]
