"""Choosing which exercises and submissions `ros-tutor check` judges."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from tutor.errors import UsageError
from tutor.judge.result import ExerciseResult, Report
from tutor.judge.submission import Submission
from tutor.judge.verdict import Status

if TYPE_CHECKING:
    from tutor.content import Course, Lesson
    from tutor.workspace import Workspace

ALL = "all"


def choose_lessons(exercise: str, criteria: Sequence[str] | None, course: Course) -> tuple[Lesson, ...]:
    """Return the lesson with this id, or all lessons; given `criteria`, only those lessons that have any of them.

    Raises UnknownExercise, and UsageError for a criterion that none of the lessons has.
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
) -> tuple[list[Submission], list[ExerciseResult]]:
    """Return, for `check all`, the submissions that exist and a skipped result for each exercise without one.

    What goes beyond the course and has not been started is not missing: nobody has to do it.

    Raises SubmissionError if there is nothing to judge at all.
    """
    from tutor.errors import SubmissionError
    from tutor.workspace import NOT_STARTED, find_submission, is_started, look_up, missing_result

    if path is None and not workspace.exists:
        find_submission(lessons[0], None, workspace)  # raises the most helpful error
    found: list[Submission] = []
    missing: list[ExerciseResult] = []
    for lesson in lessons:
        try:
            found.append(find_submission(lesson, path, workspace))
        except SubmissionError as error:
            if lesson.beyond and not is_started(lesson, path, workspace):
                continue
            why = str(error) if is_started(lesson, path, workspace) else NOT_STARTED
            missing.append(missing_result(lesson, Status.SKIPPED, why, look_up(lesson, path, workspace)))
    if not found:
        why = "; ".join(f"{result.id} {result.missing}" for result in missing)
        raise SubmissionError(f"there is nothing to judge in {path or workspace.root}: {why}")
    return found, missing


def with_missing(
    report: Report, missing: Sequence[ExerciseResult], lessons: Sequence[Lesson], only: Collection[str] | None
) -> Report:
    """Return the report with the missing exercises added, in lesson order and limited to the criteria in `only`.

    A missing exercise counts as not passed: `check all` passes only if every exercise does.
    """
    shown = [only_criteria(result, only) for result in missing]
    order = [lesson.id for lesson in lessons]
    combined = sorted((*report.exercises, *shown), key=lambda result: order.index(result.id))
    return replace(report, exercises=tuple(combined))


def only_criteria(result: ExerciseResult, only: Collection[str] | None) -> ExerciseResult:
    """Return the result limited to the criteria in `only`, if that is given."""
    return result if only is None else replace(result, criteria=tuple(c for c in result.criteria if c.id in only))
