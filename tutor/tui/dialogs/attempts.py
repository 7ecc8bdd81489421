"""Shows the learner's attempts at an exercise."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.content import Content
from textual.widgets import Static

from tutor.content import Lesson
from tutor.tui import wording
from tutor.tui.dialogs.dialog import Dialog
from tutor.tui.widgets.attempts import format_attempts
from tutor.workspace import ExerciseProgress


class AttemptsScreen(Dialog[None]):
    """The attempts at one exercise, latest first."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("a", "close", show=False),
        Binding("q", "close", show=False),
    ]

    def __init__(self, lesson: Lesson, progress: ExerciseProgress) -> None:
        super().__init__()
        self._lesson, self._progress = lesson, progress

    def compose(self) -> ComposeResult:
        with VerticalScroll(classes="window") as window:
            window.border_title = Content(f"{wording.label(self._lesson)}: your attempts")
            window.border_subtitle = "Esc closes"
            yield Static(format_attempts(self._lesson, self._progress, max_count=200), classes="dialog-text")
