"""A file was changed here and outside at once: which version goes on."""

from __future__ import annotations

from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.content import Content
from textual.widgets import Button, Static

from tutor.tui.dialogs.dialog import Dialog
from tutor.tui.widgets.code_view import CodeView
from tutor.tui.widgets.diffing import difference


class ConflictScreen(Dialog[bool]):
    """Gives True for the learner's own version, False (or None, for Esc) for the file's. Nothing is lost either way."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("d", "difference", "Difference")]

    def __init__(self, name: str, backup: str, ours: str, theirs: str) -> None:
        super().__init__()
        self._name_text, self._backup, self._ours, self._theirs = name, backup, ours, theirs

    def compose(self) -> ComposeResult:
        with Vertical(classes="window") as window:
            window.border_title = Content(f"{self._name_text} was changed outside")
            text = (
                "The file has changed on the disk while you had changes here that were not saved yet.\n\n"
                f"Both are safe: yours is kept as {self._backup}.\nWith which one do you go on?"
            )
            yield Static(text, classes="dialog-text", markup=False)
            yield CodeView(id="conflict-difference")
            with Horizontal(classes="dialog-buttons"):
                yield Button("See the difference", id="difference")
                yield Button("Take the file's", id="theirs")
                yield Button("Keep mine", id="mine")

    def on_mount(self) -> None:
        self.query_one(CodeView).display = False
        self.query_one("#mine", Button).focus()

    @on(Button.Pressed, "#difference")
    def action_difference(self) -> None:
        """Show the file's version (-) against ours (+), or hide it."""
        view = self.query_one(CodeView)
        view.show_rows(*difference(self._theirs, self._ours))
        view.display = not view.display

    @on(Button.Pressed, "#mine")
    @on(Button.Pressed, "#theirs")
    def _answer(self, event: Button.Pressed) -> None:
        self.dismiss(event.button.id == "mine")
