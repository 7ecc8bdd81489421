"""The grades on a terminal: a table of learners and exercises, what could not be judged, and frequent mistakes."""

from __future__ import annotations

from io import StringIO

from rich.console import Console
from rich.table import Table
from rich.text import Text

from tutor.grade.formats.csv_table import number
from tutor.grade.gradebook import Gradebook
from tutor.grade.points import Score
from tutor.grade.results import Result
from tutor.judge.wording import counted
from tutor.report.text import make_console
from tutor.terminal_text import printable

STYLES = {"passed": "green", "failed": "red", "missing": "yellow", "error": "magenta"}
_MARKS = {"passed": "✓", "failed": "✗", "missing": "·", "error": "!"}
_MAX_MISTAKES = 3


def render(gradebook: Gradebook, *, color: bool, width: int) -> str:
    """Render the table, `width` columns wide; a mark and points for each exercise, never colours alone."""
    out = StringIO()
    console = make_console(out, color=color, width=width)
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, 0, 0))
    table.add_column("learner", no_wrap=True, overflow="ellipsis", max_width=32)
    for lesson in gradebook.lessons:
        table.add_column(lesson.id, justify="right", no_wrap=True)
    table.add_column("points", justify="right", no_wrap=True)
    for learner in gradebook.learners:
        cells = [
            _cell(gradebook.result(learner, lesson), gradebook.score(learner, lesson)) for lesson in gradebook.lessons
        ]
        total = gradebook.total(learner)
        points = f"{number(total.score)} of {number(total.max_score)}{'' if total.complete else ' ?'}"
        table.add_row(Text(printable(learner.name)), *cells, Text(points))
    console.print(table)
    _print_mistakes(gradebook, console)
    lines = (line.rstrip() for line in out.getvalue().split("\n"))
    return "\n".join(lines).rstrip("\n") + "\n"


def _cell(result: Result | None, score: Score | None) -> Text:
    if result is None or score is None:
        return Text("-", "dim")
    points = "?" if score.score is None else number(score.score)
    return Text(f"{_MARKS[result.status]} {points}", STYLES[result.status])


def _print_mistakes(gradebook: Gradebook, console: Console) -> None:
    legend = "✓ passed  ✗ failed  · nothing to judge  ! not judged, a fault of the tool or the machine"
    console.print()
    console.print(Text(legend, "dim"))
    for lesson in gradebook.lessons:
        for mistake, name, count in gradebook.mistakes(lesson)[:_MAX_MISTAKES]:
            console.print(Text(printable(f"{lesson.id}  {counted(count, 'learner')}: {name} ({mistake})")))
