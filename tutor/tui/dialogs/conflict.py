"""Resolves a conflict: a file was changed both here and outside."""

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
from tutor.tui.widgets.diffing import diff_rows


class ConflictScreen(Dialog[bool]):
    """Returns True for the learner's version, False (or None, on Esc) for the file's. Nothing is lost either way."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("d", "difference", "Difference")]

    def __init__(self, name: str, backup: str, ours: str, theirs: str) -> None:
        super().__init__()
        self._name_text, self._backup, self._ours, self._theirs = name, backup, ours, theirs

    def compose(self) -> ComposeResult:
        with Vertical(classes="window") as window:
            window.border_title = Content(f"{self._name_text} was changed outside")
            text = (
                "The file has changed on disk while you had unsaved changes here.\n\n"
                f"Both versions are safe: yours is kept as {self._backup}.\nWhich one do you want to continue with?"
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
        """Show or hide the diff from the file's version (-) to the learner's (+)."""
        view = self.query_one(CodeView)
        view.show_rows(*diff_rows(self._theirs, self._ours))
        view.display = not view.display

    @on(Button.Pressed, "#mine")
    @on(Button.Pressed, "#theirs")
    def _answer(self, event: Button.Pressed) -> None:
        self.dismiss(event.button.id == "mine")
