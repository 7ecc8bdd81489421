"""The report as Markdown, for a pull request or a course page."""

from __future__ import annotations

import re
from collections.abc import Iterator

from tutor.judge.result import CriterionResult, ExerciseResult, Report
from tutor.report.plain import MARKS, describe, details, printable, seconds, tally

_SPECIAL = re.compile(r"([\\`*_{}\[\]<>#|~])")


def render(report: Report) -> str:
    """Write a heading and a table for each exercise, and below it what to do about each criterion that did not pass."""
    return "\n".join(_lines(report)).rstrip("\n") + "\n"


def escape(text: str) -> str:
    """Text as it is, in one line of Markdown."""
    return _SPECIAL.sub(r"\\\1", " ".join(printable(text).split()))


def _lines(report: Report) -> Iterator[str]:
    yield f"# ros-tutor: {report.verdict.value}"
    yield ""
    yield f"{escape(describe(report.environment))}, {seconds(report.duration_s)}"
    for exercise in report.exercises:
        yield ""
        yield from _exercise(exercise)


def _exercise(exercise: ExerciseResult) -> Iterator[str]:
    yield f"## {exercise.id} {escape(exercise.title)}: {exercise.verdict.value}"
    yield ""
    yield f"{tally(exercise)}, {seconds(exercise.duration_s)}"
    yield ""
    yield "| | criterion | what it asks for | time |"
    yield "|---|---|---|---:|"
    for criterion in exercise.criteria:
        status = criterion.verdict.status
        bonus = " (bonus)" if criterion.bonus else ""
        yield (
            f"| {MARKS[status]} {status.value} | {escape(criterion.id)} | {escape(criterion.text)}{bonus} "
            f"| {seconds(criterion.duration_s)} |"
        )
    for criterion in exercise.criteria:
        if not criterion.verdict.passed:
            yield ""
            yield from _diagnosis(criterion)


def _diagnosis(criterion: CriterionResult) -> Iterator[str]:
    verdict = criterion.verdict
    yield f"### {escape(criterion.id)}: {verdict.status.value}"
    yield ""
    for label, text in details(verdict):
        yield f"- **{label}:** {escape(text)}"
    if verdict.evidence:
        evidence = "\n".join(printable(line) for line in verdict.evidence)
        longest = max((len(run) for run in re.findall("`+", evidence)), default=0)
        fence = "`" * max(3, longest + 1)
        yield ""
        yield f"{fence}text"
        yield evidence
        yield fence
