"""What `ros-tutor check` shows on a terminal while it works: a line for each criterion.

Where that is more than the terminal has rows: a line for each exercise with a small bar for each criterion, and below
them as many of those under way as there is room for.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass

from rich.console import Console, Group, RenderableType
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.spinner import Spinner
from rich.table import Table
from rich.text import Text

from tutor.cli import terminal
from tutor.cli.failure_banner import first_failure
from tutor.content import Course
from tutor.judge.events import CheckStarted, CriterionJudged, Event, Progress
from tutor.judge.result import CriterionResult
from tutor.judge.verdict import Status
from tutor.report.plain import MARKS, describe_waiting, seconds
from tutor.report.text import STYLES
from tutor.terminal_text import printable

_PER_SECOND = 10
_WAITED = 22
_COLUMNS = 1 + _WAITED + 3 * 2
"""Of a line, what all but the criterion's name and the words at its end take."""

_EIGHTHS = "▁▂▃▄▅▆▇█"


@dataclass(slots=True)
class _Line:
    """One criterion, so far."""

    fraction: float = 0.0
    doing: str = ""
    result: CriterionResult | None = None
    so_far: str = ""


class ProgressDisplay:
    """Draws on stderr from the first event on, several times a second, until `close`.

    `vanishing`: wipe it at the end, because the report follows on the same terminal.
    """

    def __init__(self, course: Course, *, vanishing: bool) -> None:
        self._titles = {lesson.id: lesson.title for lesson in course.lessons}
        self._lines: dict[str, dict[str, _Line]] = {}
        self._failure: tuple[str, CriterionResult] | None = None
        self._stopping = False
        self._spinner = Spinner("dots", style="cyan")
        self._console = Console(
            stderr=True, highlight=False, markup=False, emoji=False, no_color=not terminal.wants_color(sys.stderr)
        )
        self._live = Live(
            console=self._console,
            get_renderable=self._draw,
            refresh_per_second=_PER_SECOND,
            transient=vanishing,
            redirect_stdout=False,  # stdout is the report, and may well go elsewhere
            redirect_stderr=False,
        )

    def show(self, event: Event) -> None:
        """Take in one event. The first one starts the drawing: until then, the engine may restart this process."""
        if isinstance(event, CheckStarted):
            self._lines[event.exercise] = {criterion: _Line() for criterion in event.criteria}
            if not self._live.is_started:
                self._live.start()
        elif isinstance(event, Progress):
            line = self._lines.get(event.exercise, {}).get(event.criterion)
            if line is None:
                return
            line.fraction = max(line.fraction, min(event.fraction, 1.0))
            line.doing, line.so_far = event.doing, event.so_far
        elif isinstance(event, CriterionJudged):
            line = self._lines.get(event.exercise, {}).get(event.result.id)
            if line is not None:
                line.result = event.result
            failed = event.result.verdict.status is Status.FAILED and not event.result.bonus
            if self._failure is None and failed:
                self._failure = event.exercise, event.result

    def stopping(self) -> None:
        """Say at the bottom that the end takes a moment."""
        self._stopping = True

    def close(self) -> None:
        """Stop drawing."""
        if self._live.is_started:
            self._live.stop()

    def _draw(self) -> RenderableType:
        exercises = list(self._lines)  # a copy: another thread draws while events come in
        needed = sum(len(self._lines[exercise]) + 2 for exercise in exercises)
        rows = self._console.height - 2
        failure = self._first_failure(rows // 2 - 1, several=len(exercises) > 1)
        rows -= len(failure)
        parts: list[RenderableType]
        if len(exercises) > 1 and needed > rows:
            parts = [self._summaries(exercises), *self._under_way(exercises, rows - len(exercises) - 1)]
        else:
            parts = [self._exercise(exercise) for exercise in exercises]
        if self._stopping:
            parts.append(Text("Stopping what was started ...", "yellow"))
        return Group(*failure, *parts)

    def _first_failure(self, most: int, *, several: bool) -> list[Text]:
        if self._failure is None:
            return []
        exercise, result = self._failure
        name = f"{exercise} {result.id}" if several else result.id
        return first_failure(name, result, self._console, most)

    def _exercise(self, exercise: str) -> RenderableType:
        lines = self._lines[exercise]
        heading = Text(f"{exercise} {self._titles.get(exercise, '')}", "bold")
        width = max((len(criterion) for criterion in lines), default=0)
        grid = _grid(width)
        for criterion, line in lines.items():
            grid.add_row(*self._row(criterion, line, width))
        return Group(heading, grid, "")

    def _row(self, criterion: str, line: _Line, width: int) -> tuple[RenderableType, ...]:
        if line.result is None:
            said = describe_waiting(line.doing, line.so_far, self._console.width - width - _COLUMNS)
            bar = ProgressBar(total=1.0, completed=line.fraction, width=20, complete_style="cyan")
            return self._spinner, Text(criterion), bar, Text(printable(said), "dim")
        verdict = line.result.verdict
        style = STYLES[verdict.status]
        said = "" if verdict.passed else (verdict.cause or verdict.observed)
        return (
            Text(MARKS[verdict.status], style),
            Text(criterion),
            Text(f"{verdict.status.value} after {seconds(line.result.duration_s)}", style),
            Text(" ".join(printable(said).split()), "dim"),
        )

    def _summaries(self, exercises: list[str]) -> RenderableType:
        """One line for each exercise."""
        grid = Table.grid(padding=(0, 2, 0, 0))
        grid.add_column(width=1)
        for _ in range(3):
            grid.add_column(no_wrap=True)
        grid.add_column(no_wrap=True, overflow="ellipsis")
        for exercise in exercises:
            lines = self._lines[exercise]
            results = [line.result for line in lines.values() if line.result is not None]
            passed = sum(result.verdict.passed for result in results)
            mark: RenderableType = self._spinner if len(results) < len(lines) else Text("·", "dim")
            bars = Text().join(_small_bar(line) for line in list(lines.values()))
            title = Text(self._titles.get(exercise, ""), "dim")
            grid.add_row(mark, Text(exercise), bars, Text(f"{passed} of {len(lines)} passed"), title)
        return grid

    def _under_way(self, exercises: list[str], rows: int) -> list[RenderableType]:
        """A line with a bar for criteria that are not judged yet, in this many rows."""
        under_way = [
            (line, exercise, criterion)
            for exercise in exercises
            for criterion, line in list(self._lines[exercise].items())
            if line.result is None and (line.doing or line.so_far)
        ]
        names = [f"{exercise} {criterion}" for _, exercise, criterion in under_way[: max(rows, 0)]]
        if not names:
            return []
        width = max(map(len, names))
        grid = _grid(width)
        for name, (line, _, criterion) in zip(names, under_way, strict=False):
            spinner, _, *rest = self._row(criterion, line, width)
            grid.add_row(spinner, Text(name), *rest)
        return ["", grid]


def _small_bar(line: _Line) -> Text:
    """One criterion in one column: how far it is, or how it ended."""
    if line.result is None:
        return Text(_EIGHTHS[min(int(line.fraction * len(_EIGHTHS)), len(_EIGHTHS) - 1)], "cyan")
    status = line.result.verdict.status
    return Text(MARKS[status], STYLES[status])


def _grid(width: int) -> Table:
    grid = Table.grid(padding=(0, 2, 0, 0), expand=True)
    grid.add_column(width=1)
    grid.add_column(width=width, no_wrap=True)
    grid.add_column(width=_WAITED, no_wrap=True)
    grid.add_column(ratio=1, no_wrap=True, overflow="ellipsis")
    return grid
