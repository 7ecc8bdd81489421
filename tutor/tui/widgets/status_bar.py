"""The line at the top: the lesson, and what is going on right now."""

from __future__ import annotations

from collections.abc import Sequence

from textual.app import ComposeResult
from textual.containers import Horizontal
from textual.content import Content
from textual.widgets import Static

from tutor.content import Counts, Lesson
from tutor.session.findings import Findings
from tutor.session.node import NodeState, Phase
from tutor.tui import wording
from tutor.tui.widgets.steady_static import SteadyStatic

_WIDE_COLUMNS = 100
"""From this many columns on, running nodes are named and progress is drawn as a bar."""


class StatusBar(Horizontal):
    """The program's name, the lesson, the check and the node."""

    DEFAULT_CSS = """
    StatusBar {
        height: 1;
        background: $panel;
        color: $foreground;
        & > Static { width: auto; padding: 0 1; text-wrap: nowrap; text-overflow: ellipsis; }
        & > #bar-name { background: $primary; color: $background; text-style: bold; }
        & > #bar-lesson { width: 1fr; }
        & > #bar-save { color: $foreground; display: none; }
        & > #bar-progress { color: $quiet; }
        & > #bar-build { color: $busy; display: none; }
        & > #bar-check { color: $busy; }
        & > #bar-node { color: $quiet; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._counts = Counts(0, 0)

    def compose(self) -> ComposeResult:
        yield Static("ROS Tutor", id="bar-name")
        yield SteadyStatic(id="bar-lesson")
        yield SteadyStatic(id="bar-progress")
        yield SteadyStatic(id="bar-save")
        yield SteadyStatic(id="bar-build")
        yield SteadyStatic(id="bar-check")
        yield SteadyStatic(id="bar-node")

    def show_lesson(self, lesson: Lesson) -> None:
        """Name the lesson."""
        text = Content.assemble(
            (wording.label(lesson), "bold"), f" {lesson.title}  ", (wording.LEVELS[lesson.difficulty], "$quiet")
        )
        self.query_one("#bar-lesson", Static).update(text)

    def show_progress(self, counts: Counts) -> None:
        """Show how many exercises are passed, each of the course as two cells of a bar."""
        self._counts = counts
        self._show_progress()

    def on_resize(self) -> None:
        """Show only the numbers in a narrow terminal."""
        self._show_progress()

    def _show_progress(self) -> None:
        counts = self._counts
        if self.app.size.width >= _WIDE_COLUMNS:
            bar = (("━━" * counts.passed, "$good"), ("━━" * (counts.total - counts.passed), "$line"))
            text = Content.assemble(*bar, f" {counts}")
        else:
            more = f"+{counts.passed_beyond}" if counts.passed_beyond else ""
            text = Content(f"{counts.passed}/{counts.total}{more}" if counts.total else "")
        self.query_one("#bar-progress", Static).update(text)

    def show_check(self, findings: Findings | None) -> None:
        """Show the progress of the running check; nothing if none is running."""
        text = (
            f"checking {findings.exercise.upper()} {findings.fraction:4.0%}" if findings and findings.checking else ""
        )
        static = self.query_one("#bar-check", Static)
        static.update(text)
        static.display = bool(text)

    def show_build(self, text: str) -> None:
        """Show which message types are being built; nothing if none are."""
        static = self.query_one("#bar-build", Static)
        static.update(text)
        static.display = bool(text)

    def show_nodes(self, states: Sequence[NodeState], domain: int) -> None:
        """Show which nodes are running, and on which domain."""
        alive = [state for state in states if state.alive]
        busy = [state for state in alive if state.phase is not Phase.RUNNING]
        if busy:
            text = Content.assemble(("◐ ", "$warn"), (f"{busy[0].phase.value} {busy[0].file}", "$warn"))
        elif alive:
            # In a narrow terminal, the lesson's title matters more than the file's name.
            wide = self.app.size.width >= _WIDE_COLUMNS
            names = " and ".join(state.file for state in alive) if wide or len(alive) > 1 else ""
            details = f"{names} · domain {domain}" if names else f"· domain {domain}"
            text = Content.assemble(("● ", "$good"), ("running ", "$good"), (details, "$foreground"))
        else:
            text = Content.assemble(("○ ", "$quiet"), f"domain {domain}")
        self.query_one("#bar-node", Static).update(text)

    def show_toggles(self, *, check: bool, restart: bool) -> None:
        """Show what each save triggers."""
        both = " and ".join(word for word, on in (("checks", check), ("restarts", restart)) if on)
        static = self.query_one("#bar-save", Static)
        static.update(Content.assemble(("⟳ ", "$accent"), f"a save {both}"))
        static.display = bool(both)
