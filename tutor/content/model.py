"""The data model of a course. `loader` reads it from disk, `lint` checks it for mistakes."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path

from tutor.content.live import LiveView
from tutor.content.predictions import Prediction
from tutor.errors import UnknownExercise


class Difficulty(StrEnum):
    """How hard an exercise is."""

    EASY = "easy"
    MEDIUM = "medium"
    CHALLENGE = "challenge"


@dataclass(frozen=True, slots=True)
class LessonFile:
    """One file of a submission, with the skeleton a learner starts from and our solution.

    `name` is a plain file name, or the path of a file in a package of its own, such as my_interfaces/msg/Reading.msg.
    A file that is not `required` may be missing from a submission; criteria that depend on it are then not passed. Of a
    lesson with cases (see `cases`), a file that is handed over without a fault has its solution as its skeleton.
    """

    name: str
    required: bool
    skeleton: Path
    solution: Path


@dataclass(frozen=True, slots=True)
class CriterionText:
    """A lesson's description of one criterion.

    `open`: the untouched skeleton does not pass it. Otherwise `given` names the function of the skeleton's first file
    that does, and passing is evidence only once the learner has rewritten that. `bonus`: it is shown, but never changes
    the verdict. `shows` holds the ids of the checklist items for which passing it is evidence. `calls`: for some of
    these, the method that the learner's code must call, in a node that spins; otherwise it passed by other means.
    """

    id: str
    text: str
    bonus: bool
    open: bool
    hint: str
    shows: tuple[str, ...] = ()
    given: str = ""
    calls: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Lesson:
    """One exercise: its text, its files, and the criteria it is judged by.

    `hints` go from gentle to explicit. `checklist` holds the ids of the checklist items for which passing is evidence:
    passing the criteria that show an item, or the whole exercise if no criterion shows it. `body` is Markdown without
    a title. `folder` holds the lesson's files. `live` describes what the app shows of its ROS graph. `course` is the
    name of the course, empty for the bundled one, and `heading` its title. Where an earlier course has the same id, it
    begins with the name: lamps:x1.1. `beyond`: it comes after the course, and nobody has to do it to have passed that.
    """

    id: str
    title: str
    difficulty: Difficulty
    unit: str
    objective: str
    files: tuple[LessonFile, ...]
    criteria: tuple[CriterionText, ...]
    hints: tuple[str, ...]
    checklist: tuple[str, ...]
    body: str
    folder: Path
    live: LiveView = field(default_factory=LiveView)
    predictions: tuple[Prediction, ...] = ()
    course: str = ""
    heading: str = ""
    beyond: bool = False

    @property
    def own_id(self) -> str:
        """The id within its course."""
        return self.folder.name.replace("_", ".")

    @property
    def check(self) -> Path:
        """The module or package that judges this exercise, in the `checks` folder beside the `lessons` folder.

        It has the name of the lesson's folder, which may go on with what the exercise is: i1_1_sensor_publisher.py.
        """
        folder, name = self.folder.parent.parent / "checks", self.folder.name
        found = [path for pattern in (name, f"{name}_*") for path in sorted(folder.glob(pattern)) if path.is_dir()]
        packages = [path / "__init__.py" for path in found]
        modules = [path for pattern in (name, f"{name}_*") for path in sorted(folder.glob(f"{pattern}.py"))]
        existing = [path for path in (*packages, *modules) if path.is_file()]
        return existing[0] if existing else folder / f"{name}.py"


@dataclass(frozen=True, slots=True)
class ChecklistItem:
    """One statement that a learner can tick: "I can ..."."""

    id: str
    text: str


@dataclass(frozen=True, slots=True)
class ChecklistGroup:
    """The checklist items on one subject."""

    id: str
    title: str
    items: tuple[ChecklistItem, ...]


@dataclass(frozen=True, slots=True)
class Checklist:
    """The self-assessment checklist. `ready_title` and `ready_text` are shown once every item is ticked."""

    groups: tuple[ChecklistGroup, ...] = ()
    ready_title: str = ""
    ready_text: str = ""

    @property
    def items(self) -> tuple[ChecklistItem, ...]:
        """Every item, in the order of the groups."""
        return tuple(item for group in self.groups for item in group.items)


@dataclass(frozen=True, slots=True)
class Course:
    """All lessons, in the order to do them, and the checklist."""

    lessons: tuple[Lesson, ...]
    checklist: Checklist

    def find(self, text: str) -> Lesson:
        """Find a lesson by its id, written as i1.1, I1.1 or i1_1, also after the name of its course: lamps:x1.1.

        Raises UnknownExercise if there is none.
        """
        found = self._look_up(text)
        if found is None:
            raise UnknownExercise(text, [lesson.id for lesson in self.lessons])
        return found

    def knows(self, text: str) -> bool:
        """Whether `find` would find a lesson."""
        return self._look_up(text) is not None

    def _look_up(self, text: str) -> Lesson | None:
        course, _, wanted = text.rpartition(":")
        wanted = _normalize_id(wanted)
        for lesson in self.lessons:
            if (lesson.course, lesson.own_id) == (course, wanted) if course else lesson.id == wanted:
                return lesson
        return None

    @property
    def headings(self) -> tuple[str, ...]:
        """The titles of its courses, in order."""
        return tuple(dict.fromkeys(lesson.heading for lesson in self.lessons))


def _normalize_id(text: str) -> str:
    return text.strip().lower().replace("_", ".")
