"""Which test submissions the tests judge: enough to show each criterion kept and broken, and each of the causes named
that every exercise shares.

`python -m tests.soundness` judges all of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from tutor.content.submissions import RIGHT, WRONG, Case
from tutor.judge.causes.names import MEANINGS

SHARED = tuple(f"tutor/{package}/" for package in ("engine", "judge", "process", "ros", "bundled_ros"))
ROOT = Path(__file__).parents[1]
CONTRACT = frozenset(name.casefold() for name in MEANINGS)


def sample(cases: Sequence[Case]) -> list[Case]:
    """Every tenth right one, and enough wrong ones to show each criterion of each exercise and each cause.

    Always the same ones, whatever order they come in: by name, and those that show most first.
    """
    right = sorted((case for case in cases if case.kind == RIGHT), key=str)[::10]
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
    """The cases that a change of these files (relative to the clone) may concern.

    Each case whose own files changed (or one that a link of its leads to), all of an exercise whose check, skeleton or
    solution did, and the sample where something did that all checks share.
    """
    folders = {"/".join(Path(path).parts[:5]) for path in paths if path.startswith("tests/submissions/")}
    files = {(ROOT / path).resolve() for path in paths}
    exercises = {
        Path(path).parts[1] for path in paths if path.startswith(("checks/", "lessons/")) and path.count("/") > 1
    }
    shared = any(path.startswith(SHARED) for path in paths)
    chosen = sample(cases) if shared else []

    def is_concerned(case: Case) -> bool:
        exercise = case.exercise.replace(".", "_")
        own = f"tests/submissions/{exercise}/{case.kind}/{case.folder.name}" in folders
        return exercise in exercises or own or any(link.resolve() in files for link in _links(case.folder))

    return [case for case in cases if case in chosen or is_concerned(case)]


def shows(case: Case) -> frozenset[tuple[str, str]]:
    """What a wrong submission shows: (exercise, criterion) for what it breaks, ("cause", name) for why.

    The causes are those of `tutor.judge.causes.names`; those that one exercise alone has are for the judges' own tests.
    """
    expected = case.expected
    broken = {(case.exercise, criterion) for criterion in (*expected.fails, *expected.bonus_failed)}
    return frozenset(broken | {("cause", name) for name in _first(expected.causes.values()) if name in CONTRACT})


def _links(folder: Path) -> list[Path]:
    return [path for path in folder.rglob("*") if path.is_symlink()]


def _first(causes: Iterable[Sequence[str]]) -> list[str]:
    # Of several that would do, the first is the one that its author thought of.
    return [texts[0].casefold() for texts in causes]
