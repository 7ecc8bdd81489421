"""Which fault was drawn for the learner, in an exercise that hands over a system, and which ones they have repaired."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from tutor.content import Lesson, LessonFile
from tutor.content.cases import Cases, LessonCase, cases_of, handed_over, solution_of
from tutor.errors import StorageError
from tutor.json_codec import convert_to, read_document, write_document
from tutor.workspace.atomic import write_atomically
from tutor.workspace.damaged import set_aside
from tutor.workspace.regular import read_text

SCHEMA = "ros-tutor/cases/1"

WHOLE = 6
"""So many faults, found and repaired, are the whole exercise; one passes it."""


@dataclass(frozen=True, slots=True)
class Drawn:
    """What was drawn for one exercise, by the ids of the cases, the last one being in the workspace now.

    `repaired`: those with which the exercise was passed.
    """

    cases: tuple[str, ...] = ()
    repaired: tuple[str, ...] = ()

    @property
    def current(self) -> str:
        """The case that is in the workspace; "" if none was drawn."""
        return self.cases[-1] if self.cases else ""

    def draw(self, cases: Cases, choose: Callable[[Sequence[str]], str] = random.choice) -> Drawn:
        """With another case: one that was not drawn yet, or else one that is not repaired, or else any other."""
        known = [case.id for case in cases.cases]
        others = [id for id in known if id != self.current]
        left = [id for id in known if id not in self.cases] or [id for id in others if id not in self.repaired]
        drawn = choose(left or others or known)
        return replace(self, cases=(*(id for id in self.cases if id != drawn), drawn))

    def describe(self) -> str:
        """How many are repaired, in words; "" as long as it is none."""
        number = len(self.repaired)
        return f"{number} of {max(WHOLE, number)} faults found and repaired" if number else ""


@dataclass(frozen=True, slots=True)
class _Saved:
    """The content of the file: what was drawn, by exercise id."""

    drawn: dict[str, Drawn] = field(default_factory=dict)


class DrawnCases:
    """The file with the cases of one workspace."""

    def __init__(self, path: Path, notify: Callable[[str], None]) -> None:
        self.path = path
        self._notify = notify

    def read(self, exercise: str) -> Drawn:
        """What was drawn for an exercise. Raises StorageError."""
        return self._load().get(exercise, Drawn())

    def write(self, exercise: str, drawn: Drawn) -> None:
        """Save what was drawn for an exercise. Raises StorageError."""
        write_atomically(self.path, write_document(SCHEMA, drawn={**self._load(), exercise: drawn}))

    def repaired(self, exercise: str) -> None:
        """Note that the case in the workspace is found and repaired. Raises StorageError."""
        drawn = self.read(exercise)
        if drawn.current and drawn.current not in drawn.repaired:
            self.write(exercise, replace(drawn, repaired=(*drawn.repaired, drawn.current)))

    def _load(self) -> Mapping[str, Drawn]:
        try:
            return convert_to(_Saved, read_document(read_text(self.path), SCHEMA)).drawn
        except (FileNotFoundError, NotADirectoryError):
            return {}
        except OSError as error:
            raise StorageError.of(f"read {self.path}", error) from error
        except ValueError as reason:
            aside = set_aside(self.path)
            self._notify(f"which faults were drawn could not be read ({reason}); the file is kept as {aside}")
            return {}


def skeleton_text(lesson: Lesson, file: LessonFile, drawn: Drawn) -> str:
    """A file as it was handed over to the learner: the skeleton, or that of the case that was drawn. Raises OSError."""
    found = _case(lesson, drawn)
    if found is None:
        return file.skeleton.read_text(encoding="utf-8")
    return handed_over(lesson, *found)[file.name]


def solution_text(lesson: Lesson, file: LessonFile, drawn: Drawn) -> str:
    """Our solution's file, with the answer to the case that was drawn. Raises OSError."""
    found = _case(lesson, drawn)
    return file.solution.read_text(encoding="utf-8") if found is None else solution_of(file, *found)


def _case(lesson: Lesson, drawn: Drawn) -> tuple[Cases, LessonCase] | None:
    cases = cases_of(lesson) if drawn.current else None
    case = cases.find(drawn.current) if cases is not None else None
    return (cases, case) if cases is not None and case is not None else None
