"""All keys, and how an exercise goes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Container, VerticalScroll
from textual.content import Content
from textual.widgets import Static

from tutor.tui.commands import EDITOR_KEYS, GROUPS, Command
from tutor.tui.screens.dialog import Dialog

_HOW = (
    "Read the lesson, start, edit, run, check. A failure tells you the next step.\n"
    "In the editor letters type: leave it with Esc. The F keys work everywhere."
)


_EVERYWHERE = (
    ("Ctrl+P", "Find any action, lesson, or text"),
    ("Tab", "Move between the panels"),
)

HALF = 3
"""So many groups are in the left column."""

TWO_COLUMNS = 116
"""From this width on there are two."""


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
            yield Static(_HOW, classes="dialog-text")
            with Container(id="help-columns"):
                yield Static(_text(GROUPS[:HALF]), classes="dialog-text")
                yield Static(
                    _text(GROUPS[HALF:], ("Everywhere", _EVERYWHERE), ("In the editor", EDITOR_KEYS)),
                    classes="dialog-text",
                )

    def on_resize(self, event: events.Resize) -> None:
        """Two columns where there is room."""
        self.set_class(event.size.width >= TWO_COLUMNS, "-two")


def _text(groups: Sequence[tuple[str, tuple[Command, ...]]], *more: tuple[str, Sequence[tuple[str, str]]]) -> Content:
    parts: list[Content | str | tuple[str, str]] = []
    for title, keys in (*((title, _merged(group)) for title, group in groups), *more):
        parts += ["\n\n" if parts else "", (title, "bold $primary")]
        for key, text in keys:
            parts += ["\n", (f"{key:<9} ", "bold $accent"), text]
    return Content.assemble(*parts)


def _merged(group: tuple[Command, ...]) -> list[tuple[str, str]]:
    """One line for each action; its keys together."""
    lines: dict[str, list[str]] = {}
    for command in group:
        lines.setdefault(command.help or command.text, []).extend(command.shown_keys)
    return [(" ".join(keys), text) for text, keys in lines.items()]
