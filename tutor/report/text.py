"""The report for people in a terminal, or in a file."""

from __future__ import annotations

from io import StringIO

from rich.console import Console, Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from tutor.judge.result import CriterionResult, ExerciseResult, Report
from tutor.judge.verdict import Status
from tutor.report.plain import MARKS, describe, details, printable, seconds, tally

STYLES = {Status.PASSED: "green", Status.FAILED: "red", Status.SKIPPED: "yellow", Status.ERROR: "magenta"}

_INDENT = 4


def render(report: Report, *, color: bool, width: int) -> str:
    """Write the report, `width` columns wide. The verdict is always a word too, never a colour alone."""
    out = StringIO()
    console = Console(
        file=out,
        force_terminal=color,
        force_jupyter=False,
        color_system="standard" if color else None,
        no_color=not color,
        width=max(width, 40),
        highlight=False,
        markup=False,
        emoji=False,
    )
    for exercise in report.exercises:
        console.print(_exercise(exercise))
    console.print(_summary(report))
    lines = (line.rstrip() for line in out.getvalue().split("\n"))
    return "\n".join(lines).rstrip("\n") + "\n"


def _exercise(exercise: ExerciseResult) -> RenderableType:
    name = (f"{exercise.id} {exercise.title}", "bold")
    verdict = (exercise.verdict.value.upper(), f"bold {STYLES[exercise.verdict]}")
    if exercise.missing:
        return Padding(Group(Text.assemble(name, "  ", verdict), _missing(exercise)), (0, 0, 1, 0))
    heading = Text.assemble(name, "  ", verdict, (f"  {tally(exercise)}, {seconds(exercise.duration_s)}", "dim"))
    files = Text(printable(", ".join(exercise.submission)), "dim")
    parts: list[RenderableType] = [heading, *([files] if exercise.submission else []), ""]
    id_width = max((len(criterion.id) for criterion in exercise.criteria), default=0)
    for criterion in exercise.criteria:
        parts.append(_headline(criterion, id_width))
        if not criterion.verdict.passed:
            below = 0 if criterion.verdict.status is Status.SKIPPED else 1
            parts.append(Padding(_diagnosis(criterion), (0, 0, below, _INDENT)))
    return Padding(Group(*parts), (0, 0, 1, 0))


def _missing(exercise: ExerciseResult) -> RenderableType:
    hint = exercise.criteria[0].verdict.hint
    return Padding(Text(printable(f"{exercise.missing}; {hint}" if hint else exercise.missing), "yellow"), (0, 0, 0, 2))


def _headline(criterion: CriterionResult, id_width: int) -> RenderableType:
    status = criterion.verdict.status
    row = Table.grid(padding=(0, 2, 0, 0), expand=True)
    row.add_column(width=len("✓ skipped"), no_wrap=True)
    row.add_column(width=id_width, no_wrap=True)
    row.add_column(ratio=1)
    row.add_column(width=7, justify="right", no_wrap=True)
    text = Text(printable(criterion.text))
    if criterion.bonus:
        text.append(" (bonus)", "dim")
    row.add_row(
        Text(f"{MARKS[status]} {status.value}", STYLES[status]),
        Text(criterion.id, "bold"),
        text,
        Text(seconds(criterion.duration_s), "dim"),
    )
    return row


def _diagnosis(criterion: CriterionResult) -> RenderableType:
    grid = Table.grid(padding=(0, 2, 0, 0))
    grid.add_column(width=len("next step"), no_wrap=True, style="dim")
    grid.add_column(overflow="fold")
    if criterion.verdict.status is Status.ERROR:
        grid.add_row("", Text("This could not be judged. It is no fault of your code.", "magenta"))
    for label, text in details(criterion.verdict):
        grid.add_row(label, Text(text, "bold" if label == "next step" else ""))
    for number, line in enumerate(criterion.verdict.evidence):
        grid.add_row("" if number else "evidence", Text(printable(line), "dim"))
    return grid


def _summary(report: Report) -> RenderableType:
    verdict = report.verdict
    passed = sum(exercise.verdict is Status.PASSED for exercise in report.exercises)
    of = f"  {passed} of {len(report.exercises)} exercises passed" if len(report.exercises) > 1 else ""
    return Text.assemble(
        (f"{MARKS[verdict]} {verdict.value}", f"bold {STYLES[verdict]}"),
        of,
        (f"  in {seconds(report.duration_s)}\n{describe(report.environment)}", "dim"),
    )
