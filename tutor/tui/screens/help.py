"""All keys, and how an exercise goes."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.content import Content
from textual.widgets import Static

from tutor.tui.commands import GROUPS, Command
from tutor.tui.screens.dialog import Dialog

_HOW = "Read the lesson, start the exercise, edit the file, run it, check it. A failure tells you the next step."


class HelpScreen(Dialog[None]):
    """Made from the table of commands, so it is never out of date."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("question_mark", "close", show=False),
        Binding("q", "close", show=False),
    ]

    def compose(self) -> ComposeResult:
        with VerticalScroll(classes="window") as window:
            window.border_title = "Help"
            window.border_subtitle = "Esc closes"
            yield Static(_text(), classes="dialog-text")


def _text() -> Content:
    parts: list[Content | str | tuple[str, str]] = [_HOW]
    for title, group in GROUPS:
        parts += ["\n\n", (title, "bold $primary")]
        for key, text in _merged(group):
            parts += ["\n  ", (f"{key:<8}", "bold $accent"), text]
    for key, text in (
        ("Ctrl+P", "Find any action or lesson by name"),
        ("Tab", "Move between the panels; arrows move in them"),
    ):
        parts += ["\n  ", (f"{key:<8}", "bold $accent"), text]
    return Content.assemble(*parts)


def _merged(group: tuple[Command, ...]) -> list[tuple[str, str]]:
    """One line for each action; its keys together."""
    lines: dict[str, list[str]] = {}
    for command in group:
        lines.setdefault(command.text, []).append(command.shown_key)
    return [(" ".join(keys), text) for text, keys in lines.items()]
