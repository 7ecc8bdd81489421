"""The hints of a lesson, as many as were asked for."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.content import Content
from textual.widgets import Static

from tutor.content import Lesson
from tutor.tui import words
from tutor.tui.screens.dialog import Dialog


class HintScreen(Dialog[bool]):
    """Gives True where the next hint is wanted."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("h", "another", "Next hint"),
        Binding("enter", "close", show=False),
    ]

    def __init__(self, lesson: Lesson, shown: int) -> None:
        super().__init__()
        self._lesson, self._shown = lesson, shown

    def compose(self) -> ComposeResult:
        hints = self._lesson.hints
        more = "h: next hint · " if self._shown < len(hints) else ""
        parts: list[Content | str | tuple[str, str]] = []
        for number, hint in enumerate(hints[: self._shown], start=1):
            last = number == self._shown
            parts += [
                (f"{number}  ", "bold $accent"),
                (hint, "bold" if last and number > 1 else ""),
                "" if last else "\n\n",
            ]
        with VerticalScroll(classes="window") as window:
            window.border_title = f"{words.label(self._lesson)}: hint {self._shown} of {len(hints)}"
            window.border_subtitle = f"{more}Esc closes"
            yield Static(Content.assemble(*parts), classes="dialog-text")

    def action_another(self) -> None:
        """Ask for the next one, if there is one."""
        if self._shown < len(self._lesson.hints):
            self.dismiss(True)
