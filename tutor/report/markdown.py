"""The report as Markdown, for a pull request or a course page."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from html import escape as escape_html

from tutor.invocation import command
from tutor.judge.result import CriterionResult, ExerciseResult, Report
from tutor.judge.verdict import Status
from tutor.report.plain import (
    MARKS,
    REMARKS_HEADING,
    describe,
    details,
    evidence_lines,
    missing_lines,
    one_line,
    remark_lines,
    seconds,
    tally,
)
from tutor.terminal_text import printable

_SPECIAL = re.compile(r"([\\`*_{}\[\]<>#|~$]|&(?=#?\w+;))")
_MENTION = re.compile(r"@(?=\w)")
_MAX_LENGTH = 2000


def render(report: Report) -> str:
    """Render a heading and a table per exercise, followed by a diagnosis of each criterion that did not pass."""
    return "\n".join(_lines(report)).rstrip("\n") + "\n"


def escape(text: str) -> str:
    """Escape text as one line of literal Markdown: without markup, HTML, table cell ends or @mentions."""
    return _MENTION.sub("@<!-- -->", _SPECIAL.sub(r"\\\1", " ".join(printable(text).split())))


def _lines(report: Report) -> Iterator[str]:
    yield f"# ros-tutor: {report.verdict.value}"
    yield ""
    if report.message:
        yield escape(report.message)
        yield ""
    passed = sum(exercise.verdict is Status.PASSED for exercise in report.exercises)
    several = f"{passed} of {len(report.exercises)} exercises passed, " if len(report.exercises) > 1 else ""
    yield f"{several}{escape(describe(report.environment))}, {seconds(report.duration_s)}"
    if several:
        yield ""
        yield from _overview(report)
    for exercise in report.exercises:
        yield ""
        yield from _exercise(exercise)


def _overview(report: Report) -> Iterator[str]:
    yield "| | exercise | criteria | time |"
    yield "|---|---|---|---:|"
    for exercise in report.exercises:
        verdict = exercise.verdict
        counted = escape(exercise.missing) or tally(exercise)
        name = f"{exercise.id} {escape(exercise.title)}"
        yield f"| {MARKS[verdict]} {verdict.value} | {name} | {counted} | {seconds(exercise.duration_s)} |"


def _exercise(exercise: ExerciseResult) -> Iterator[str]:
    yield f"## {exercise.id} {escape(exercise.title)}: {exercise.verdict.value}"
    yield ""
    if exercise.missing:
        first, *more = missing_lines(exercise)
        yield escape(first)
        for line in more:
            yield ""
            yield escape(line)
        return
    yield f"{tally(exercise)}, {seconds(exercise.duration_s)}"
    yield ""
    yield "| | criterion | what it asks for | time |"
    yield "|---|---|---|---:|"
    for criterion in exercise.criteria:
        status = criterion.verdict.status
        bonus = " (bonus)" if criterion.bonus else ""
        yield (
            f"| {MARKS[status]} {status.value} | {escape(criterion.id)} | {escape(one_line(criterion.text))}{bonus} "
            f"| {seconds(criterion.duration_s)} |"
        )
    for criterion in exercise.criteria:
        if not criterion.verdict.passed:
            yield ""
            yield from _diagnosis(criterion)
    if exercise.remarks:
        yield ""
        yield f"**{REMARKS_HEADING}**"
        yield ""
        for line, remark in zip(remark_lines(exercise), exercise.remarks, strict=True):
            yield f"- {escape(line)} More: `{command('explain', remark.mistake)}`"


def _diagnosis(criterion: CriterionResult) -> Iterator[str]:
    """Yield a collapsible block, open if the criterion failed or had an error and counts towards the verdict."""
    verdict = criterion.verdict
    unfolded = " open" if verdict.status in (Status.FAILED, Status.ERROR) and not criterion.bonus else ""
    bonus = " (bonus)" if criterion.bonus else ""
    title = escape_html(one_line(f"{MARKS[verdict.status]} {criterion.id}: {verdict.status.value}{bonus}"))
    yield f"<details{unfolded}><summary>{title}</summary>"
    yield ""
    for label, text in details(verdict):
        yield f"- **{label}:** {escape(one_line(text, _MAX_LENGTH))}"
    if verdict.evidence:
        yield ""
        yield from _fenced(evidence_lines(verdict))
    yield ""
    yield "</details>"


def _fenced(lines: Sequence[str]) -> Iterator[str]:
    """Yield the lines as a fenced block, with a fence longer than any run of backticks in them."""
    longest = max((len(run) for line in lines for run in re.findall("`+", line)), default=0)
    fence = "`" * max(3, longest + 1)
    yield f"{fence}text"
    yield from lines
    yield fence
