"""What is said of a criterion that did not pass, on every page."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tutor.grade.formats.csv_table import number
from tutor.grade.formats.html.markup import Html, element, inline, joined
from tutor.grade.points import CriterionScore, Score
from tutor.judge.result import CriterionResult, ExerciseResult, Remark
from tutor.judge.verdict import Status, Verdict
from tutor.report.plain import evidence_lines, remark_lines


def told(exercise: ExerciseResult) -> list[CriterionResult]:
    """Return the criteria that did not pass for a reason of their own, required ones first."""
    own = [
        criterion
        for criterion in exercise.criteria
        if criterion.verdict.status in (Status.FAILED, Status.ERROR) and not criterion.verdict.same_as
    ]
    return sorted(own, key=lambda criterion: criterion.bonus)


def verdict_details(verdict: Verdict, *, steps: bool = True) -> Html:
    """Return what was expected and observed, why, and, with `steps`, what to do next."""
    pairs = (
        ("expected", verdict.expected),
        ("observed", verdict.observed),
        ("why", verdict.cause),
        ("next step", verdict.step if steps else ""),
    )
    rows = [row(label, inline(value.strip())) for label, value in pairs if value.strip()]
    if lines := evidence_lines(verdict):
        rows.append(row("evidence", element("pre", "\n".join(lines))))
    return element("dl", *rows, class_="diagnosis")


def row(label: str, value: str) -> Html:
    """Return one labelled value of a description list."""
    return element("div", element("dt", label), element("dd", value), class_=label.replace(" ", "-"))


def following(exercise: ExerciseResult) -> Html:
    """Return the criteria that another one explains, one item for each reason; empty if there are none."""
    by_reason: dict[str, list[CriterionResult]] = {}
    for criterion in exercise.criteria:
        if criterion.verdict.same_as or criterion.verdict.status is Status.SKIPPED:
            by_reason.setdefault(criterion.verdict.cause, []).append(criterion)
    items = (element("li", names(criteria), ": ", inline(reason)) for reason, criteria in by_reason.items())
    return element("ul", *items, class_="following") if by_reason else Html()


def names(criteria: Iterable[CriterionResult]) -> Html:
    """Return the ids of criteria, separated by commas."""
    return joined((element("code", criterion.id) for criterion in criteria), ", ")


def remarks(exercise: ExerciseResult) -> Sequence[tuple[Remark, str]]:
    """Return the remarks on an exercise, each with its line of text."""
    return list(zip(exercise.remarks, remark_lines(exercise), strict=True))


def points_of(score: Score | None, criterion: str) -> str:
    """Return the points of a criterion, such as "0 of 2.5"; empty if it is worth none."""
    found: CriterionScore | None = next(
        (scored for scored in score.criteria if scored.id == criterion) if score is not None else iter(()), None
    )
    if found is None or not found.max_score:
        return ""
    return f"{'?' if found.score is None else number(found.score)} of {number(found.max_score)}"
