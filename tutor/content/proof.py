"""What the verdicts on our own skeleton and solution must be."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.content.model import CriterionText, Lesson
from tutor.content.problem import Problem
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status


def find_disproofs(lesson: Lesson, kind: str, result: ExerciseResult) -> Iterator[Problem]:
    """Where the verdicts on the "skeleton" or the "solution" are not what the lesson says.

    Our solution passes every criterion, bonus included. The untouched skeleton fails on the criteria that it leaves
    open, and on no other; one that is skipped because of a failed one is neither. What could not be judged is no
    finding: see `faults`.
    """
    texts = {text.id: text for text in lesson.criteria}
    for criterion in result.criteria:
        text = texts.get(criterion.id)
        said = _of_solution(criterion) if kind == "solution" else _of_skeleton(criterion, text) if text else ""
        if said:
            yield _problem(lesson, kind, criterion, said)
    if kind == "skeleton" and not any(c.verdict.status in (Status.FAILED, Status.ERROR) for c in result.criteria):
        yield Problem(lesson.folder / kind, "no criterion fails", "leave something to do")


def faults(result: ExerciseResult) -> list[CriterionResult]:
    """What could not be judged, through no fault of the course."""
    return [criterion for criterion in result.criteria if criterion.verdict.status is Status.ERROR]


def _of_solution(criterion: CriterionResult) -> str:
    return "" if criterion.verdict.status in (Status.PASSED, Status.ERROR) else "does not pass"


def _of_skeleton(criterion: CriterionResult, text: CriterionText) -> str:
    if criterion.verdict.status is Status.FAILED and not text.open:
        return "fails, and the lesson says that it is not open"
    if criterion.verdict.passed and text.open:
        return "passes, and the lesson says that it is open"
    return ""


def _problem(lesson: Lesson, kind: str, criterion: CriterionResult, said: str) -> Problem:
    verdict = criterion.verdict
    seen = " | ".join(text for text in (verdict.observed, verdict.cause) if text)
    return Problem(
        lesson.folder / kind,
        f"{criterion.id} {said}" + (f" ({seen})" if seen else ""),
        "fix the check, the lesson's `open`, or the code",
    )
