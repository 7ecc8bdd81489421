"""The checklist in Markdown: a GitHub task list, and a table of the exercises."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.report.assessment import AssessedExercise, AssessedItem, Assessment
from tutor.report.checklist_formats import TITLE
from tutor.report.markdown import escape
from tutor.report.phrases import calendar_day, describe_evidence, describe_status


def render(assessment: Assessment, *, at: str) -> str:
    """Render the document as Markdown text with a final newline."""
    return "\n".join(_lines(assessment, at)) + "\n"


def _lines(assessment: Assessment, at: str) -> Iterator[str]:
    yield f"# {TITLE}"
    yield ""
    count = f"{assessment.ticked} of {len(assessment.items)} ticked"
    yield f"{count}, {assessment.counts.text('exercises')} ({escape(calendar_day(at))})."
    for group in assessment.groups:
        yield ""
        yield f"## {escape(group.title)}"
        yield ""
        yield from (_task(item) for item in group.items)
    if assessment.ready:
        yield ""
        yield f"## {escape(assessment.ready_title)}"
        yield ""
        yield escape(assessment.ready_text)
    if assessment.exercises:
        yield ""
        yield "## Exercises"
        yield ""
        yield "| exercise | difficulty | status | criteria | bonus | attempts |"
        yield "|---|---|---|--:|--:|--:|"
        yield from (_row(exercise) for exercise in assessment.exercises)


def _task(item: AssessedItem) -> str:
    evidence = escape("; ".join(describe_evidence(item.evidence, calendar_day)))
    return f"- [{'x' if item.ticked else ' '}] {escape(item.text)}{f' ({evidence})' if evidence else ''}"


def _row(exercise: AssessedExercise) -> str:
    cells = (
        escape(f"{exercise.id} {exercise.title}"),
        escape(exercise.difficulty),
        escape(describe_status(exercise)),
        f"{exercise.met} of {exercise.required}",
        f"{exercise.bonus_met} of {exercise.bonus}" if exercise.bonus else "",
        str(exercise.attempts),
    )
    return f"| {' | '.join(cells)} |"
