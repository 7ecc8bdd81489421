"""Which exercise is next, and the command for it: for `list` and `next`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from tutor.invocation import command

if TYPE_CHECKING:
    from tutor.content import Lesson
    from tutor.workspace import ExerciseState


def next_lesson(lessons: Sequence[Lesson], states: Mapping[str, ExerciseState]) -> Lesson | None:
    """Return the first exercise that is not passed; None if all are. `states` maps exercise ids to states.

    Those of a course in which something has been started come first: whoever has started one learns there. Those that
    go beyond their course come last.
    """
    begun = {lesson.course for lesson in lessons if states[lesson.id].is_started}
    left = [lesson for lesson in lessons if not states[lesson.id].is_passed]
    return min(left, key=lambda lesson: (lesson.beyond, lesson.course not in begun), default=None)


def next_command(lesson: Lesson | None, states: Mapping[str, ExerciseState]) -> str:
    """Return the command to type for `next_lesson`."""
    if lesson is None:
        return command("checklist")
    return command("start" if not states[lesson.id].is_started else "check", lesson.id)
