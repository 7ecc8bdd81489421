"""What a course is made of. Facts only: reading it from disk is `loader`, proving it right is `lint`."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path

from tutor.content.live import LiveView
from tutor.errors import UnknownExercise


class Difficulty(StrEnum):
    """How hard an exercise is."""

    EASY = "easy"
    MEDIUM = "medium"
    CHALLENGE = "challenge"


@dataclass(frozen=True, slots=True)
class LessonFile:
    """One file of a submission, with the file a learner starts from and our own answer.

    A file that is not `required` may be missing from a submission; what depends on it is then not passed.
    """

    name: str
    required: bool
    skeleton: Path
    solution: Path


@dataclass(frozen=True, slots=True)
class CriterionText:
    """One criterion in words.

    `open`: the untouched skeleton does not pass it. `bonus`: it is shown, but never changes the verdict. `shows` holds
    the ids of the checklist items that passing it gives evidence for.
    """

    id: str
    text: str
    bonus: bool
    open: bool
    hint: str
    shows: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Lesson:
    """One exercise: its text, the files it asks for, and what will be judged.

    `hints` go from gentle to plain. `checklist` holds the ids of the checklist items that passing gives evidence for:
    by the criteria that show an item, or by the exercise as a whole where none of them does. `body` is Markdown,
    without a title. `folder` is where all of it lies. `live` is what of it the app shows on DDS.
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

    @property
    def check(self) -> Path:
        """The package or module that judges this exercise, in the `checks` folder beside the `lessons` folder."""
        name = self.folder.parent.parent / "checks" / self.folder.name
        package = name / "__init__.py"
        return package if package.is_file() else name.with_name(f"{name.name}.py")


@dataclass(frozen=True, slots=True)
class ChecklistItem:
    """One thing that a learner can tick: "I can ..."."""

    id: str
    text: str


@dataclass(frozen=True, slots=True)
class ChecklistGroup:
    """Checklist items of one subject."""

    id: str
    title: str
    items: tuple[ChecklistItem, ...]


@dataclass(frozen=True, slots=True)
class Checklist:
    """The self-assessment checklist. `ready_title` and `ready_text` are for anyone who has ticked every item."""

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
        """Find a lesson by its id, written as i1.1, I1.1 or i1_1.

        Raises UnknownExercise where there is none.
        """
        wanted = _id_of(text)
        for lesson in self.lessons:
            if lesson.id == wanted:
                return lesson
        raise UnknownExercise(text, [lesson.id for lesson in self.lessons])

    def knows(self, text: str) -> bool:
        """Whether `find` would find a lesson."""
        return any(lesson.id == _id_of(text) for lesson in self.lessons)


def _id_of(text: str) -> str:
    return text.strip().lower().replace("_", ".")
