"""A class as a teacher gets it, made of the test submissions, and what each learner must get."""

from __future__ import annotations

import csv
import random
import shutil
import zipfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from tests.hostile import find_hostile
from tests.judging import compare, find_cases, holds_here
from tutor import workspace
from tutor.content import Course, load_course
from tutor.content.submissions import EXPECT, RIGHT, WRONG, Case
from tutor.grade.points import DEFAULT_POINTS, Points
from tutor.grade.results import Result

HOSTILE, HANGING, CRASHING, EMPTY, MISNAMED = "hostile", "hanging", "crashing", "empty", "misnamed"
KINDS = (
    *(RIGHT, WRONG, RIGHT, HANGING, WRONG, RIGHT, CRASHING, WRONG, RIGHT, HOSTILE),
    *(WRONG, RIGHT, MISNAMED, WRONG, RIGHT, EMPTY, WRONG, RIGHT, HANGING, WRONG),
    *(RIGHT, CRASHING, WRONG, RIGHT, HOSTILE, WRONG, RIGHT, WRONG, EMPTY, MISNAMED),
)
"""What thirty learners hand in for one exercise."""

_TEMPLATE = Path(workspace.__file__).parent / "template" / "src" / "my_package"

_CAUSES = {
    HANGING: ("no spin", "blocked executor", "deadlock"),
    CRASHING: ("unhandled exception", "import error", "syntax error", "crash on exit"),
}


@dataclass(frozen=True, slots=True)
class Expectation:
    """What a learner must get for an exercise. `case` is None if there is nothing to judge."""

    kind: str
    case: Case | None = None

    def deviations(self, result: Result) -> list[str]:
        """Return in which way a result is not as it must be; nothing if it is."""
        if self.case is None:
            score = Points().score(result).score
            return [] if (result.status, score) == ("missing", 0.0) else [f"{result.status} with {score}, not missing"]
        if result.judged is None or result.status == "missing":
            return [f"not judged: {result.report.message or result.status}"]
        case = self.case
        if self.kind == HOSTILE:  # in isolation, what it tries fails with another error
            case = replace(case, expected=replace(case.expected, causes={}))
        return [*compare(case, result.judged).wrong, *self._wrong_points(result)]

    def _wrong_points(self, result: Result) -> Iterator[str]:
        """Yield what is wrong with the points by default: equal parts for what passed, all for what is right."""
        assert result.judged is not None
        required = [criterion.verdict for criterion in result.judged.criteria if not criterion.bonus]
        passed = sum(verdict.passed for verdict in required)
        score = Points().score(result)
        if score.max_score != DEFAULT_POINTS:
            yield f"{score.max_score} points at most"
        if score.score is None:
            if result.status != "error":
                yield "no points, though it was judged"
        elif abs(score.score - DEFAULT_POINTS * passed / len(required)) > 1e-6:
            yield f"{score.score} points for {passed} of {len(required)} criteria"
        if self.case is not None and self.case.expected.passes and score.score not in (DEFAULT_POINTS, None):
            yield f"{score.score} points for a right submission"


@dataclass
class MadeClass:
    """A class in `folder`, with a roster. `expected`: by the learner's id and the exercise."""

    folder: Path
    roster: Path
    expected: dict[tuple[str, str], Expectation] = field(default_factory=dict)

    def deviations(self, results: Iterable[Result]) -> list[str]:
        """Return in which way the results are not as they must be, in a line each."""
        by_key = {(result.learner.id, result.exercise): result for result in results}
        lines = [
            f"{learner} {exercise}: nobody expects it" for learner, exercise in by_key.keys() - self.expected.keys()
        ]
        for (learner, exercise), expectation in self.expected.items():
            result = by_key.get((learner, exercise))
            found = ["no result"] if result is None else expectation.deviations(result)
            case = f" ({expectation.case})" if expectation.case is not None else ""
            lines += [f"{learner} {exercise} {expectation.kind}{case}: {text}" for text in found]
        return lines


def make_class(
    folder: Path,
    learners: int = 30,
    exercises: Sequence[str] = ("i1.1", "i2.2"),
    seed: int = 1,
    kinds: Sequence[str] = KINDS,
) -> MadeClass:
    """Make a class below `folder`, which must be empty or missing: what they hand in, and how, varies.

    One learner more is on the roster, who hands in nothing.
    """
    chance = random.Random(seed)
    course = load_course()
    pools = {exercise: _Pool(exercise, chance) for exercise in exercises}
    made = MadeClass(folder / "class", folder / "roster.csv")
    made.folder.mkdir(parents=True)
    names = [f"learner-{number:02}" for number in range(1, learners + 2)]
    for number, name in enumerate(names):
        files: dict[str, dict[str, Path]] = {}
        for place, exercise in enumerate(exercises):
            kind = kinds[(number + 11 * place) % len(kinds)] if number < learners else EMPTY
            case = pools[exercise].take(kind)
            made.expected[name, exercise] = Expectation(kind, case)
            files[exercise] = _files(case or pools[exercise].right, kind, course)
        if number < learners:
            _LAYOUTS[number % len(_LAYOUTS)](made.folder, name, files)
    with made.roster.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("folder", "name", "id", "email"))
        writer.writerows((name, f"Zoë {name}", 100 + at, f"{name}@example.org") for at, name in enumerate(names))
    return made


class _Pool:
    """The test submissions of an exercise by kind, in an order of chance; each comes round again."""

    def __init__(self, exercise: str, chance: random.Random) -> None:
        usable = [
            case
            for case in (*find_cases([f"{exercise}/"])[0], *find_hostile())
            if case.exercise == exercise
            and holds_here(case)
            and not case.expected.keeps_busy
            and case.expected.exit != 3
        ]
        chance.shuffle(usable)
        kinds = {kind: [case for case in usable if case.kind == kind] for kind in (RIGHT, WRONG, HOSTILE)}
        for kind, causes in _CAUSES.items():
            kinds[kind] = [case for case in kinds[WRONG] if _first_cause(case) in causes]
        self._cases = {kind: cases or kinds[WRONG] for kind, cases in kinds.items()}
        self._taken = dict.fromkeys(kinds, 0)
        self.right = kinds[RIGHT][0]

    def take(self, kind: str) -> Case | None:
        """Return the next submission of a kind; None for those in which there is nothing to judge."""
        if kind not in self._cases:
            return None
        self._taken[kind] += 1
        return self._cases[kind][(self._taken[kind] - 1) % len(self._cases[kind])]


def _first_cause(case: Case) -> str:
    return next((texts[0].casefold() for texts in case.expected.causes.values()), "")


def _files(case: Case, kind: str, course: Course) -> dict[str, Path]:
    """Return what is handed in, by path."""
    if kind == EMPTY:
        return {}
    found = {
        path.relative_to(case.folder).as_posix(): path
        for path in case.folder.rglob("*")
        if path.is_file() and path.name != EXPECT and "__pycache__" not in path.parts
    }
    if kind == MISNAMED:
        names = {file.name for file in course.find(case.exercise).files}
        found = {f"my {name}" if name in names else name: path for name, path in found.items()}
    return found


# --- how it is handed in ---

_Files = dict[str, dict[str, Path]]


def _by_exercise(files: _Files, exercise: Callable[[str], str] = lambda exercise: exercise) -> dict[str, Path]:
    return {f"{exercise(name)}/{path}": source for name, inner in files.items() for path, source in inner.items()}


def _copy(files: dict[str, Path], folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name, source in files.items():
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, target)  # what a link leads to


def _zip(files: dict[str, Path], archive: Path) -> None:
    archive.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as opened:
        for name, source in files.items():
            opened.writestr(name, source.read_bytes())


def _in_folder(top: Path, name: str, files: _Files) -> None:
    _copy(_by_exercise(files), top / name)


def _in_deep_folder(top: Path, name: str, files: _Files) -> None:
    _copy(_by_exercise(files, lambda exercise: f"robotics/{exercise.replace('.', '_')}"), top / name)


def _in_zip(top: Path, name: str, files: _Files) -> None:
    _zip(_by_exercise(files), top / f"{name}.zip")


def _in_moodle(top: Path, name: str, files: _Files) -> None:
    _copy(_by_exercise(files), top / f"{name}_{name[-2:]}7_assignsubmission_file_")


def _in_zip_in_moodle(top: Path, name: str, files: _Files) -> None:
    _zip(
        _by_exercise(files, lambda exercise: f"my work/{exercise}"),
        top / f"{name}_{name[-2:]}8_assignsubmission_file_/work.zip",
    )


def _in_canvas(top: Path, name: str, files: _Files) -> None:
    _zip(_by_exercise(files), top / f"{name}_LATE_4{name[-2:]}_9{name[-2:]}_work-1.zip")


def _in_clone(top: Path, name: str, files: _Files) -> None:
    clone = top / f"robotics-{name}"
    _copy(_by_exercise(files), clone)
    for exercise, inner in files.items():
        for folder in (".git/x", f"build/{exercise}", ".venv/lib", f"install/{exercise}"):
            _copy(inner, clone / folder)


def _in_workspace(top: Path, name: str, files: _Files) -> None:
    """As the app makes it, if the exercises' own files are all there is; else by exercise."""
    inner = {path: source for files_of_one in files.values() for path, source in files_of_one.items()}
    if len(inner) < sum(map(len, files.values())) or any("/" in path for path in inner) or len(inner) > len(files):
        _in_folder(top, name, files)
        return
    package = top / name / "src" / "my_package"
    shutil.copytree(_TEMPLATE, package)
    _copy(
        {f"{'launch' if path.endswith('launch.py') else 'my_package'}/{path}": at for path, at in inner.items()},
        package,
    )


_LAYOUTS = (
    *(_in_folder, _in_zip, _in_moodle, _in_clone, _in_workspace, _in_canvas, _in_zip_in_moodle, _in_deep_folder),
)
