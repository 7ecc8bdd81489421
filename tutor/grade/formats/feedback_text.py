"""What a learner is told, as plain text: shared by the formats of systems that show it to them."""

from __future__ import annotations

from collections.abc import Sequence

from tutor.grade.formats.csv_table import number
from tutor.grade.points import Score
from tutor.grade.results import Result
from tutor.invocation import PROGRAM
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status
from tutor.report.plain import REMARKS_HEADING, details, evidence_lines, one_line, remark_lines
from tutor.terminal_text import printable

FAULT = "a fault of the tool or the machine, not of the submission"


def fault_of(result: Result) -> str:
    """Return in a line what kept an exercise from being judged; empty if nothing did."""
    judged = result.judged
    if judged is None:
        return one_line(result.report.message)
    if judged.missing:
        return ""
    return next((one_line(criterion.verdict.cause) for criterion in judged.criteria if _is_unjudged(criterion)), "")


def _is_unjudged(criterion: CriterionResult) -> bool:
    return criterion.verdict.status is Status.ERROR and not criterion.bonus


def criterion_text(exercise: ExerciseResult, criterion: CriterionResult, *, steps: bool) -> str:
    """Return all that is known of a criterion, `printable`. Without `steps`, nothing of what to do about a failure."""
    verdict = criterion.verdict
    if verdict.passed:
        return printable(verdict.observed)
    if exercise.missing:
        return "\n".join(_missing_lines(exercise))
    if verdict.status is Status.ERROR:
        return f"not judged: {one_line(verdict.cause)} ({FAULT})"
    lines = [f"{label}: {text}" for label, text in details(verdict, steps=False)]
    lines += _advice(criterion) if steps else []
    return "\n".join([*lines, *(f"  {line}" for line in evidence_lines(verdict))])


def exercise_text(result: Result, score: Score, *, steps: bool) -> str:
    """Return a summary of an exercise, `printable`: its points, what passed, and why the rest did not."""
    judged = result.judged
    title = result.exercise if judged is None else f"{judged.id} {judged.title}"
    if score.score is None:
        return f"{title}: not judged: {fault_of(result)} ({FAULT})"
    heading = f"{title}: {number(score.score)} of {number(score.max_score)} points"
    if judged is None or judged.missing:
        return "\n".join([heading, *(_missing_lines(judged) if judged is not None else ())])
    passed = [criterion.id for criterion in judged.criteria if criterion.verdict.passed]
    lines = [heading, f"passed: {', '.join(passed) or 'nothing'}"]
    for criterion in judged.criteria:
        if not criterion.verdict.passed:
            bonus = " (bonus)" if criterion.bonus else ""
            lines.append(f"{criterion.id}{bonus}: {one_line(criterion.verdict.cause or criterion.verdict.observed)}")
            lines += [f"  {line}" for line in _advice(criterion)] if steps else []
    remarks = remark_lines(judged)
    return "\n".join([*lines, *([REMARKS_HEADING, *remarks] if remarks else [])])


def _advice(criterion: CriterionResult) -> Sequence[str]:
    """Return the next step, and where to read more: by the program's own name, not as it was started here."""
    verdict = criterion.verdict
    if verdict.status is not Status.FAILED:
        return []
    step = [f"next step: {one_line(verdict.step)}"] if verdict.step else []
    more = [f"more: {PROGRAM} explain {verdict.mistake}"] if verdict.mistake and not verdict.same_as else []
    return step + more


def _missing_lines(exercise: ExerciseResult) -> list[str]:
    lines = [exercise.missing]
    if exercise.lookup is not None:
        lines.append(f"looked for: {', '.join(exercise.lookup.looked_for)}")
        lines.append(f"found there: {', '.join(exercise.lookup.found) or 'nothing'}")
    return [one_line(line, 1000) for line in lines]
