"""How a learner stands with an exercise, and what is next: for `list` and `next`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from tutor.invocation import command

if TYPE_CHECKING:
    from tutor.content import Lesson
    from tutor.workspace import ExerciseState


def next_lesson(lessons: Sequence[Lesson], known: Mapping[str, ExerciseState]) -> Lesson | None:
    """The first exercise that is not passed; None where all are."""
    return next((lesson for lesson in lessons if not known[lesson.id].is_passed), None)


def next_command(lesson: Lesson | None, known: Mapping[str, ExerciseState]) -> str:
    """What to type for `next_lesson`."""
    if lesson is None:
        return command("checklist")
    return command("start" if not known[lesson.id].is_started else "check", lesson.id)
