"""What `ros-tutor check` is asked to judge."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from tutor.cli.errors import UsageError
from tutor.judge.submission import Submission

if TYPE_CHECKING:
    from tutor.content import Course, Lesson
    from tutor.workspace import Workspace

ALL = "all"


def choose_lessons(exercise: str, criteria: Sequence[str] | None, course: Course) -> tuple[Lesson, ...]:
    """The lesson with this id, or all; of these, the ones that have any of `criteria`.

    Raises UnknownExercise; UsageError for a criterion that none of them has.
    """
    lessons = course.lessons if exercise.lower() == ALL else (course.find(exercise),)
    if not criteria:
        return lessons
    known = {criterion.id: None for lesson in lessons for criterion in lesson.criteria}
    for wanted in criteria:
        if wanted not in known:
            where = lessons[0].id if len(lessons) == 1 else "any exercise"
            raise UsageError(f"there is no criterion {wanted!r} in {where}. The criteria are: {', '.join(known)}")
    return tuple(lesson for lesson in lessons if any(criterion.id in criteria for criterion in lesson.criteria))


def choose_submissions(
    lessons: Sequence[Lesson], path: Path | None, workspace: Workspace
) -> tuple[list[Submission], list[str]]:
    """For `check all`: the submissions that are there, and what to say about what is left out.

    Raises SubmissionError where there is none at all.
    """
    from tutor.workspace import SubmissionError, find_submission, is_started

    if path is None and not workspace.exists:
        find_submission(lessons[0], None, workspace)  # raises: it knows best what to say
    found: list[Submission] = []
    left_out = []
    for lesson in lessons:
        if is_started(lesson, path, workspace):
            try:
                found.append(find_submission(lesson, path, workspace))
            except SubmissionError as error:
                left_out.append(f"left out: {error}")
    missing = [lesson.id for lesson in lessons if not is_started(lesson, path, workspace)]
    if missing:
        left_out.append(f"not started, so not judged: {', '.join(missing)}")
    if not found:
        raise SubmissionError(f"there is nothing to judge in {path or workspace.root} ({'; '.join(left_out)})")
    return found, left_out
