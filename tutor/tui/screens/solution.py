"""Our solution, beside the lesson's file names."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical

from tutor.content import Lesson
from tutor.tui import words
from tutor.tui.screens.dialog import Dialog
from tutor.tui.widgets.code_view import CodeView


class SolutionScreen(Dialog[None]):
    """Shows the files one at a time; `sources` maps their names to their texts."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("f", "next_file", "Other file"),
        Binding("v", "close", show=False),
        Binding("q", "close", show=False),
    ]

    def __init__(self, lesson: Lesson, sources: Mapping[str, str]) -> None:
        super().__init__()
        self._lesson, self._sources, self._index = lesson, sources, 0

    def compose(self) -> ComposeResult:
        with Vertical(classes="window -wide"):
            yield CodeView(id="solution-code")

    def on_mount(self) -> None:
        self._show()
        self.query_one(CodeView).focus()

    def action_next_file(self) -> None:
        """Show the next file."""
        self._index = (self._index + 1) % len(self._sources)
        self._show()

    def _show(self) -> None:
        name, text = list(self._sources.items())[self._index]
        window = self.query_one(".window")
        window.border_title = f"{words.label(self._lesson)} solution: {name}"
        window.border_subtitle = "f: other file · Esc closes" if len(self._sources) > 1 else "Esc closes"
        view = self.query_one(CodeView)
        view.show_source(text)
        view.scroll_home(animate=False)
