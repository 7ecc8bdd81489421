"""The live display of `ros-tutor check` on a terminal: one line per criterion.

If the terminal has too few rows for that: one line per exercise with a tiny bar per criterion, and below them as many
of the criteria in progress as fit.
"""

from __future__ import annotations

from dataclasses import dataclass

from rich.console import Group, RenderableType
from rich.progress_bar import ProgressBar
from rich.spinner import Spinner
from rich.table import Table
from rich.text import Text

from tutor.cli.failure_banner import render_banner
from tutor.cli.live_console import live, stderr_console
from tutor.content import Course
from tutor.judge.events import CheckStarted, CriterionJudged, Event, Progress
from tutor.judge.result import CriterionResult
from tutor.judge.verdict import Status
from tutor.report.plain import MARKS, describe_waiting, seconds
from tutor.report.text import STYLES
from tutor.terminal_text import printable

_REFRESH_HZ = 10
_BAR_COLUMN_WIDTH = 22
_FIXED_WIDTH = 1 + _BAR_COLUMN_WIDTH + 3 * 2
"""Width of a line without the criterion's name and the text at its end: the mark, the bar and three gaps."""

_EIGHTHS = "▁▂▃▄▅▆▇█"


@dataclass(slots=True)
class _Line:
    """The state of one criterion."""

    fraction: float = 0.0
    doing: str = ""
    result: CriterionResult | None = None
    so_far: str = ""


class ProgressDisplay:
    """Draws on stderr, several times a second, from the first event until `close`.

    `vanishing`: erase the display at the end, because the report follows on the same terminal.
    """

    def __init__(self, course: Course, *, vanishing: bool) -> None:
        self._titles = {lesson.id: lesson.title for lesson in course.lessons}
        self._lines: dict[str, dict[str, _Line]] = {}
        self._failure: tuple[str, CriterionResult] | None = None
        self._stopping = False
        self._spinner = Spinner("dots", style="cyan")
        self._console = stderr_console()
        self._live = live(self._console, self._draw, _REFRESH_HZ, vanishing=vanishing)

    def show(self, event: Event) -> None:
        """Process one event. The first one starts the drawing: until then, the engine may restart this process."""
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
        """Say at the bottom that stopping takes a moment."""
        self._stopping = True

    def close(self) -> None:
        """Stop drawing."""
        if self._live.is_started:
            self._live.stop()

    def _draw(self) -> RenderableType:
        exercises = list(self._lines)  # a copy: another thread draws while events come in
        needed = sum(len(self._lines[exercise]) + 2 for exercise in exercises)
        rows = self._console.height - 2
        banner = self._render_banner(rows // 2 - 1, several=len(exercises) > 1)
        rows -= len(banner)
        parts: list[RenderableType]
        if len(exercises) > 1 and needed > rows:
            parts = [self._summaries(exercises), *self._in_progress(exercises, rows - len(exercises) - 1)]
        else:
            parts = [self._exercise(exercise) for exercise in exercises]
        if self._stopping:
            parts.append(Text("Stopping everything that was started ...", "yellow"))
        return Group(*banner, *parts)

    def _render_banner(self, max_rows: int, *, several: bool) -> list[Text]:
        if self._failure is None:
            return []
        exercise, result = self._failure
        name = f"{exercise} {result.id}" if several else result.id
        return render_banner(name, result, self._console, max_rows)

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
            text = describe_waiting(line.doing, line.so_far, self._console.width - width - _FIXED_WIDTH)
            bar = ProgressBar(total=1.0, completed=line.fraction, width=20, complete_style="cyan")
            return self._spinner, Text(criterion), bar, Text(printable(text), "dim")
        verdict = line.result.verdict
        style = STYLES[verdict.status]
        text = "" if verdict.passed else (verdict.cause or verdict.observed)
        return (
            Text(MARKS[verdict.status], style),
            Text(criterion),
            Text(f"{verdict.status.value} after {seconds(line.result.duration_s)}", style),
            Text(" ".join(printable(text).split()), "dim"),
        )

    def _summaries(self, exercises: list[str]) -> RenderableType:
        """Return one line per exercise."""
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

    def _in_progress(self, exercises: list[str], rows: int) -> list[RenderableType]:
        """Return a line with a bar for each criterion in progress, as many as fit into `rows`."""
        in_progress = [
            (line, exercise, criterion)
            for exercise in exercises
            for criterion, line in list(self._lines[exercise].items())
            if line.result is None and (line.doing or line.so_far)
        ]
        names = [f"{exercise} {criterion}" for _, exercise, criterion in in_progress[: max(rows, 0)]]
        if not names:
            return []
        width = max(map(len, names))
        grid = _grid(width)
        for name, (line, _, criterion) in zip(names, in_progress, strict=False):
            spinner, _, *rest = self._row(criterion, line, width)
            grid.add_row(spinner, Text(name), *rest)
        return ["", grid]


def _small_bar(line: _Line) -> Text:
    """Return one character for a criterion: its progress, or its verdict."""
    if line.result is None:
        return Text(_EIGHTHS[min(int(line.fraction * len(_EIGHTHS)), len(_EIGHTHS) - 1)], "cyan")
    status = line.result.verdict.status
    return Text(MARKS[status], STYLES[status])


def _grid(width: int) -> Table:
    grid = Table.grid(padding=(0, 2, 0, 0), expand=True)
    grid.add_column(width=1)
    grid.add_column(width=width, no_wrap=True)
    grid.add_column(width=_BAR_COLUMN_WIDTH, no_wrap=True)
    grid.add_column(ratio=1, no_wrap=True, overflow="ellipsis")
    return grid
