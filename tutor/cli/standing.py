"""How a learner stands with an exercise, and what is next: for `list` and `next`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import Enum
from typing import TYPE_CHECKING

from tutor.invocation import command

if TYPE_CHECKING:
    from tutor.content import Course, Lesson
    from tutor.workspace import Progress, Workspace


class Standing(Enum):
    """How far a learner is; the values are those of `list --format json`."""

    PASSED = "passed"
    NOT_PASSED = "not_passed"
    STARTED = "started"
    NOT_STARTED = "not_started"


def standings(course: Course, progress: Progress, workspace: Workspace) -> dict[str, Standing]:
    """How the learner stands with each exercise, by its id."""
    return {lesson.id: _standing(lesson, progress, workspace) for lesson in course.lessons}


def next_lesson(lessons: Sequence[Lesson], known: Mapping[str, Standing]) -> Lesson | None:
    """The first exercise that is not passed; None where all are."""
    return next((lesson for lesson in lessons if known[lesson.id] is not Standing.PASSED), None)


def next_command(lesson: Lesson | None, known: Mapping[str, Standing]) -> str:
    """What to type for `next_lesson`."""
    if lesson is None:
        return command("checklist")
    return command("start" if known[lesson.id] is Standing.NOT_STARTED else "check", lesson.id)


def _standing(lesson: Lesson, progress: Progress, workspace: Workspace) -> Standing:
    from tutor.workspace import is_started

    found = progress.of(lesson.id)
    if found.best is not None and found.best.value == "passed":
        return Standing.PASSED
    if found.attempts:
        return Standing.NOT_PASSED
    return Standing.STARTED if found.started_at or is_started(lesson, None, workspace) else Standing.NOT_STARTED
