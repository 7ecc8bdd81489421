"""Lets the learner choose one of a lesson's commands to run."""

from __future__ import annotations

from collections.abc import Sequence

from textual import on
from textual.app import ComposeResult
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import OptionList

from tutor.tui.dialogs.dialog import Dialog


class ChooseCommandScreen(Dialog[str]):
    """Returns the command chosen."""

    DEFAULT_CSS = """
    ChooseCommandScreen OptionList { height: auto; max-height: 20; border: none; background: $surface; }
    ChooseCommandScreen OptionList:focus { border: none; }
    """

    def __init__(self, commands: Sequence[str]) -> None:
        super().__init__()
        self._commands = commands

    def compose(self) -> ComposeResult:
        with Vertical(classes="window") as window:
            window.border_title = "Run a command of the lesson"
            window.border_subtitle = "Enter runs it in the terminal · Esc closes"
            yield OptionList(*(Content(command) for command in self._commands))

    @on(OptionList.OptionSelected)
    def _chosen(self, event: OptionList.OptionSelected) -> None:
        event.stop()
        self.dismiss(self._commands[event.option_index])
