"""How grading goes: a live table on a terminal, or a line for each result."""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

from rich.console import Group, RenderableType
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from tutor.cli import terminal
from tutor.cli.interruptible_run import Display
from tutor.cli.live_console import live, stderr_console
from tutor.grade.capacity import Cost, estimate_s, words_for
from tutor.grade.formats.text import STYLES
from tutor.grade.grading import Plan, Watcher
from tutor.grade.results import Result
from tutor.grade.unit import OnEvent
from tutor.grade.work import Work
from tutor.judge.events import Event, Progress
from tutor.report.plain import seconds
from tutor.terminal_text import printable

_REFRESH_HZ = 4
_RECENT = 8


class GradeDisplay(Display, Watcher, Protocol):
    """Shows how grading goes, on stderr."""


@dataclass(slots=True)
class _Running:
    """One check that is running, since a time of the monotonic clock."""

    name: str
    since: float
    doing: str = ""


class _Remaining:
    """How long the rest takes: what was estimated, corrected by how fast it went so far."""

    def __init__(self, plan: Plan, slots: int, costs: Mapping[str, Cost], cores: float) -> None:
        self._todo = Counter(work.exercise for work in plan.todo)
        self._slots = slots
        self._costs = costs
        self._cores = cores
        self._whole_s = self._estimate()
        self._started = time.monotonic()

    def finished(self, result: Result) -> None:
        if result.status != "missing" and result.attempt == 1:
            self._todo[result.exercise] -= 1

    @property
    def seconds(self) -> float:
        left_s = self._estimate()
        done_s = self._whole_s - left_s
        elapsed_s = time.monotonic() - self._started
        pace = elapsed_s / done_s if done_s > 0.1 * self._whole_s else 1.0
        return left_s * max(pace, 0.2)

    def _estimate(self) -> float:
        return estimate_s(self._todo.elements(), self._costs, self._slots, self._cores)


class _Lines:
    """A line on stderr for each result."""

    def __init__(self, plan: Plan, remaining: _Remaining) -> None:
        self._total = len(plan.todo) + len(plan.missing)
        self._done: set[tuple[str, str]] = set()
        self._remaining = remaining

    def started(self, work: Work) -> None:
        pass

    def event(self, work: Work) -> OnEvent:
        return lambda event: None

    def finished(self, result: Result) -> None:
        self._done.add((result.learner.id, result.exercise))
        self._remaining.finished(result)
        terminal.say(f"{len(self._done):4} of {self._total}  {_describe(result)}")

    def show(self, event: Event) -> None:
        pass

    def stopping(self) -> None:
        terminal.say("stopping everything that was started")

    def close(self) -> None:
        pass


class _Table:
    """A table of what runs, what came last, and how long the rest takes, redrawn several times a second."""

    def __init__(self, plan: Plan, remaining: _Remaining) -> None:
        self._total = len(plan.todo) + len(plan.missing)
        self._remaining = remaining
        self._running: dict[tuple[str, str], _Running] = {}
        self._results: dict[tuple[str, str], Result] = {}
        self._stopping = False
        self._console = stderr_console()
        self._live = live(self._console, self._draw, _REFRESH_HZ, vanishing=True)
        self._live.start()

    def started(self, work: Work) -> None:
        name = _one_line(f"{work.learner.name}  {work.exercise}")
        self._running[work.learner.id, work.exercise] = _Running(name, time.monotonic())

    def event(self, work: Work) -> OnEvent:
        running = self._running[work.learner.id, work.exercise]

        def follow(event: Event) -> None:
            if isinstance(event, Progress):
                running.doing = event.doing or running.doing

        return follow

    def finished(self, result: Result) -> None:
        key = result.learner.id, result.exercise
        self._running.pop(key, None)
        self._results.pop(key, None)  # so that a second attempt is the last one
        self._results[key] = result
        self._remaining.finished(result)

    def show(self, event: Event) -> None:
        pass

    def stopping(self) -> None:
        self._stopping = True

    def close(self) -> None:
        self._live.stop()

    def _draw(self) -> RenderableType:
        results = list(self._results.values())  # copies: another thread draws
        grid = Table.grid(padding=(0, 2, 0, 0), expand=True)
        grid.add_column(no_wrap=True, overflow="ellipsis", ratio=2)
        grid.add_column(no_wrap=True, width=10)
        grid.add_column(no_wrap=True, overflow="ellipsis", ratio=3)
        rows = max(3, self._console.height - 6 - len(self._running))
        for result in results[-min(_RECENT, rows) :]:
            text = Text(result.status, STYLES[result.status])
            name = _one_line(f"{result.learner.name}  {result.exercise}")
            grid.add_row(Text(name), text, Text(_one_line(_tell(result)), "dim"))
        for running in list(self._running.values()):
            passed = seconds(time.monotonic() - running.since)
            grid.add_row(Text(running.name, "cyan"), Text(passed, "cyan"), Text(_one_line(running.doing), "dim"))
        done = len(results)
        left = f"about {words_for(self._remaining.seconds)} left" if done < self._total else ""
        counts = Counter(result.status for result in results)
        tally = "  ".join(f"{count} {status}" for status, count in sorted(counts.items()))
        bar = ProgressBar(total=max(self._total, 1), completed=done, width=30, complete_style="cyan")
        summary = Table.grid(padding=(0, 2, 0, 0))
        summary.add_row(bar, Text(f"{done} of {self._total}"), Text(tally), Text(left, "dim"))
        parts: list[RenderableType] = [grid, "", summary]
        if self._stopping:
            parts.append(Text("Stopping everything that was started ...", "yellow"))
        return Group(*parts)


def display_for(plan: Plan, slots: int, costs: Mapping[str, Cost], cores: float) -> GradeDisplay:
    """Return a live table if stderr is a terminal, else lines."""
    remaining = _Remaining(plan, slots, costs, cores)
    return _Table(plan, remaining) if terminal.can_animate(sys.stderr) else _Lines(plan, remaining)


def _describe(result: Result) -> str:
    return _one_line(f"{result.learner.name}  {result.exercise}  {result.status}  {_tell(result)}").rstrip()


def _one_line(text: str) -> str:
    return printable(text.replace("\n", " "))


def _tell(result: Result) -> str:
    judged = result.judged
    if judged is None:
        return result.report.message
    if judged.missing:
        return judged.missing
    required = [criterion for criterion in judged.criteria if not criterion.bonus]
    failed = [criterion.id for criterion in required if not criterion.verdict.passed]
    took = seconds(judged.duration_s)
    return took if not failed else f"{took}, not passed: {', '.join(failed)}"
