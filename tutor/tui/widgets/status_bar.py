"""The line at the top: which lesson, and what is going on right now."""

from __future__ import annotations

from collections.abc import Sequence

from textual.app import ComposeResult
from textual.containers import Horizontal
from textual.content import Content
from textual.widgets import Static

from tutor.content import Lesson
from tutor.session.findings import Findings
from tutor.session.node import NodeState, Phase
from tutor.tui import wording
from tutor.tui.widgets.steady_static import SteadyStatic

WIDE = 100
"""From this many columns on, what runs is named."""


class StatusBar(Horizontal):
    """Name of the program, the lesson, the check and the node."""

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
        & > #bar-check { color: $busy; }
        & > #bar-node { color: $quiet; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._passed = 0, 0

    def compose(self) -> ComposeResult:
        yield Static("ROS Tutor", id="bar-name")
        yield SteadyStatic(id="bar-lesson")
        yield SteadyStatic(id="bar-progress")
        yield SteadyStatic(id="bar-save")
        yield SteadyStatic(id="bar-check")
        yield SteadyStatic(id="bar-node")

    def show_lesson(self, lesson: Lesson) -> None:
        """Name the lesson."""
        text = Content.assemble(
            (wording.label(lesson), "bold"), f" {lesson.title}  ", (wording.LEVELS[lesson.difficulty], "$quiet")
        )
        self.query_one("#bar-lesson", Static).update(text)

    def show_progress(self, passed: int, total: int) -> None:
        """Say how many exercises are passed; of the bar, each has two cells."""
        self._passed = passed, total
        self._show_progress()

    def on_resize(self) -> None:
        """In a narrow terminal the numbers alone."""
        self._show_progress()

    def _show_progress(self) -> None:
        passed, total = self._passed
        if self.app.size.width >= WIDE:
            bar = (("━━" * passed, "$good"), ("━━" * (total - passed), "$line"))
            text = Content.assemble(*bar, f" {passed} of {total} passed")
        else:
            text = Content(f"{passed}/{total}" if total else "")
        self.query_one("#bar-progress", Static).update(text)

    def show_check(self, findings: Findings | None) -> None:
        """Say how far the running check is; nothing where none runs."""
        text = (
            f"checking {findings.exercise.upper()} {findings.fraction:4.0%}" if findings and findings.checking else ""
        )
        place = self.query_one("#bar-check", Static)
        place.update(text)
        place.display = bool(text)

    def show_nodes(self, states: Sequence[NodeState], domain: int) -> None:
        """Say which nodes run, and on which domain."""
        alive = [state for state in states if state.alive]
        busy = [state for state in alive if state.phase is not Phase.RUNNING]
        if busy:
            text = Content.assemble(("◐ ", "$warn"), (f"{busy[0].phase.value} {busy[0].file}", "$warn"))
        elif alive:
            wide = self.app.size.width >= WIDE  # else the lesson's title is worth more than the file's name
            names = " and ".join(state.file for state in alive) if wide or len(alive) > 1 else ""
            about = f"{names} · domain {domain}" if names else f"· domain {domain}"
            text = Content.assemble(("● ", "$good"), ("running ", "$good"), (about, "$foreground"))
        else:
            text = Content.assemble(("○ ", "$quiet"), f"domain {domain}")
        self.query_one("#bar-node", Static).update(text)

    def show_toggles(self, *, check: bool, restart: bool) -> None:
        """Say what happens on each save."""
        both = " and ".join(word for word, on in (("checks", check), ("restarts", restart)) if on)
        place = self.query_one("#bar-save", Static)
        place.update(Content.assemble(("⟳ ", "$accent"), f"a save {both}"))
        place.display = bool(both)
