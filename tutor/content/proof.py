"""Compares the verdicts on a lesson's skeleton and solution with what the lesson declares."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from tutor.content.expectations import find_deviations
from tutor.content.model import CriterionText, Lesson
from tutor.content.places import find_line
from tutor.content.problem import Problem
from tutor.content.submissions import Case
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status


def find_contradictions(lesson: Lesson, kind: str, result: ExerciseResult) -> Iterator[Problem]:
    """Find where the verdicts on the "skeleton" or the "solution" (`kind`) contradict the lesson.

    The solution must pass every criterion, bonus included. The untouched skeleton must fail the criteria that it leaves
    open and no others; a criterion skipped because of a failed one may be either. Criteria that could not be judged
    are no findings: see `unjudged_criteria`.
    """
    texts = {text.id: text for text in lesson.criteria}
    for criterion in result.criteria:
        text = texts.get(criterion.id)
        if kind == "solution":
            contradiction = _contradiction_of_solution(criterion)
        else:
            contradiction = _contradiction_of_skeleton(criterion, text) if text else ""
        if contradiction:
            yield _make_problem(lesson, kind, criterion, contradiction)
    if kind == "skeleton" and not any(c.verdict.status in (Status.FAILED, Status.ERROR) for c in result.criteria):
        yield Problem(lesson.folder / kind, "no criterion fails", "leave something to do")


def find_wrong_verdicts(case: Case, result: ExerciseResult, left: Sequence[str] = ()) -> Iterator[Problem]:
    """Find where the verdict on a test submission is not what its `expect.yaml`, or its patch, says.

    `left`: the processes with the text of `gone` that it has left behind.
    Criteria that could not be judged are no findings: see `unjudged_criteria`.
    """
    unjudged = {criterion.id for criterion in unjudged_criteria(result)}
    for deviation in find_deviations(case.expected, result):
        if deviation.criterion not in unjudged:
            line = find_line(case.source, _expects(deviation.criterion)) if deviation.criterion else None
            hint = "fix the check, or what is expected here"
            yield Problem(case.source, deviation.text.removesuffix(" | "), hint, line)
    for command in left:
        yield Problem(case.source, f"left behind: {command.strip()}", "end it", find_line(case.source, "^gone:"))


def _expects(criterion: str) -> str:
    """Return a pattern for the line of a case that names a criterion, not in what it says or changes."""
    return rf"^(?!says:|\s*-? *(from|to|in):).*(?<![\w-]){re.escape(criterion)}(?![\w-])"


def unjudged_criteria(result: ExerciseResult) -> list[CriterionResult]:
    """Return the criteria that could not be judged, through no fault of the course."""
    return [criterion for criterion in result.criteria if criterion.verdict.status is Status.ERROR]


def _contradiction_of_solution(criterion: CriterionResult) -> str:
    return "" if criterion.verdict.status in (Status.PASSED, Status.ERROR) else "does not pass"


def _contradiction_of_skeleton(criterion: CriterionResult, text: CriterionText) -> str:
    if criterion.verdict.status is Status.FAILED and not text.open:
        return "fails, but the lesson says that it is not open"
    if criterion.verdict.passed and text.open:
        return "passes, but the lesson says that it is open"
    return ""


def _make_problem(lesson: Lesson, kind: str, criterion: CriterionResult, contradiction: str) -> Problem:
    verdict = criterion.verdict
    details = " | ".join(text for text in (verdict.observed, verdict.cause) if text)
    return Problem(
        lesson.folder / kind,
        f"{criterion.id} {contradiction}" + (f" ({details})" if details else ""),
        "fix the check, the lesson's `open`, or the code",
    )
