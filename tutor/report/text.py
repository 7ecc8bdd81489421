"""The report as plain text, for a terminal or a file."""

from __future__ import annotations

from collections.abc import Iterator
from io import StringIO

from rich.console import Console, Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from tutor.invocation import command
from tutor.judge.result import CriterionResult, ExerciseResult, Report
from tutor.judge.verdict import Status
from tutor.report.plain import (
    MARKS,
    REMARKS_HEADING,
    describe,
    details,
    isolation_lines,
    missing_lines,
    remark_lines,
    seconds,
    tally,
)
from tutor.terminal_text import printable

STYLES = {Status.PASSED: "green", Status.FAILED: "red", Status.SKIPPED: "yellow", Status.ERROR: "magenta"}

_INDENT = 4


def render(report: Report, *, color: bool, width: int) -> str:
    """Render the report, `width` columns wide. Verdicts are always words as well, never colours alone."""
    out = StringIO()
    console = make_console(out, color=color, width=max(width, 40))
    for exercise in report.exercises:
        for part in _exercise(exercise):
            console.print(part)
    console.print(_summary(report))
    lines = (line.rstrip() for line in out.getvalue().split("\n"))
    return "\n".join(lines).rstrip("\n") + "\n"


def make_console(out: StringIO, *, color: bool, width: int) -> Console:
    """Return a console that writes plain text, `width` columns wide, to `out`: nothing in a text is markup."""
    return Console(
        file=out,
        force_terminal=color,
        force_jupyter=False,
        color_system="standard" if color else None,
        no_color=not color,
        width=width,
        highlight=False,
        markup=False,
        emoji=False,
    )


def _exercise(exercise: ExerciseResult) -> Iterator[RenderableType]:
    name = (f"{exercise.id} {exercise.title}", "bold")
    verdict = (exercise.verdict.value.upper(), f"bold {STYLES[exercise.verdict]}")
    if exercise.missing:
        yield Padding(Group(Text.assemble(name, "  ", verdict), _missing(exercise)), (0, 0, 1, 0))
        return
    heading = Text.assemble(name, "  ", verdict, (f"  {tally(exercise)}, {seconds(exercise.duration_s)}", "dim"))
    files = Text(printable(", ".join(exercise.submission)), "dim")
    yield Group(heading, *([files] if exercise.submission else []), "")
    id_width = max((len(criterion.id) for criterion in exercise.criteria), default=0)
    for criterion in exercise.criteria:
        yield _headline(criterion, id_width)
        if not criterion.verdict.passed:
            yield from _diagnosis(criterion)
            if criterion.verdict.status is not Status.SKIPPED:
                yield ""
    if exercise.remarks:
        yield ""
        yield Text(REMARKS_HEADING, "bold yellow")
        for line, remark in zip(remark_lines(exercise), exercise.remarks, strict=True):
            yield _row("remark", Text(line))
            yield _row("more", Text(command("explain", remark.mistake), "dim"))
    yield ""


def _missing(exercise: ExerciseResult) -> RenderableType:
    return Padding(Text("\n".join(missing_lines(exercise)), "yellow"), (0, 0, 0, 2))


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


def _diagnosis(criterion: CriterionResult) -> Iterator[RenderableType]:
    if criterion.verdict.status is Status.ERROR:
        yield _row("", Text("This could not be judged. It is no fault of your code.", "magenta"))
    for label, text in details(criterion.verdict):
        styles = {"next step": "bold", "more": "dim"}
        yield _row(label, Text(text, styles.get(label, "")))
    for number, line in enumerate(criterion.verdict.evidence):
        yield _row("" if number else "evidence", Text(printable(line), "dim"))


def _row(label: str, text: Text) -> RenderableType:
    grid = Table.grid(padding=(0, 2, 0, 0))
    grid.add_column(width=len("next step"), no_wrap=True, style="dim")
    grid.add_column(overflow="fold")
    grid.add_row(label, text)
    return Padding(grid, (0, 0, 0, _INDENT))


def _summary(report: Report) -> RenderableType:
    verdict = report.verdict
    passed = sum(exercise.verdict is Status.PASSED for exercise in report.exercises)
    tally_text = f"  {passed} of {len(report.exercises)} exercises passed" if len(report.exercises) > 1 else ""
    duration = f"  in {seconds(report.duration_s)}"
    return Text.assemble(
        (f"{MARKS[verdict]} {verdict.value}", f"bold {STYLES[verdict]}"),
        f": {printable(report.message)}\n" if report.message else "",
        tally_text,
        (
            "\n".join([duration, describe(report.environment), *isolation_lines(report)]),
            "dim",
        ),
    )
