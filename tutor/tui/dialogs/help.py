"""All keys, and how an exercise goes."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap
from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Container, VerticalScroll
from textual.content import Content
from textual.geometry import Size
from textual.widget import Widget
from textual.widgets import Static

from tutor.tui.commands import EDITOR_KEYS, GROUPS, Command
from tutor.tui.dialogs.dialog import Dialog

_HOW = (
    "Read the lesson, start, edit, run, check. A failure tells you the next step.\n"
    "In the editor letters type: leave it with Esc. The F keys work everywhere."
)


_EVERYWHERE = (
    ("Ctrl+P", "Find any action, lesson, or text"),
    ("Tab", "Move between the panels"),
)

KeyGroup = tuple[str, Sequence[tuple[str, str]]]
"""A title, and keys with what they do."""

KEYS = 10
"""Columns of the keys."""

HALF = 3
"""This many groups are in the left column."""

TWO_COLUMNS = 116
"""From this width on there are two."""


class KeyTable(Widget):
    """Groups of keys and what they do; what does not fit into a line goes on below its beginning."""

    DEFAULT_CSS = "KeyTable { height: auto; }"

    def __init__(self, *groups: KeyGroup) -> None:
        super().__init__()
        self._groups = groups

    def render(self) -> Content:
        """For the width that there is."""
        return self._text(self.content_size.width)

    def get_content_height(self, container: Size, viewport: Size, width: int) -> int:
        """As many lines as it takes."""
        return self._text(width).plain.count("\n") + 1

    def _text(self, width: int) -> Content:
        parts: list[Content | str | tuple[str, str]] = []
        for title, keys in self._groups:
            parts += ["\n\n" if parts else "", (title, "bold $primary")]
            for key, text in keys:
                first, *rest = wrap(text, max(20, width - KEYS)) or [""]
                parts += ["\n", (f"{key:<{KEYS - 1}} ", "bold $accent"), first]
                parts += [f"\n{' ' * KEYS}{line}" for line in rest]
        return Content.assemble(*parts)


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
                yield KeyTable(*_merged(GROUPS[:HALF]), ("In the editor", EDITOR_KEYS))
                yield KeyTable(("Everywhere", _EVERYWHERE), *_merged(GROUPS[HALF:]))

    def on_resize(self, event: events.Resize) -> None:
        """Two columns where there is room."""
        self.set_class(event.size.width >= TWO_COLUMNS, "-two")


def _merged(groups: Sequence[tuple[str, tuple[Command, ...]]]) -> list[KeyGroup]:
    """One line for each action; its keys together."""
    merged: list[KeyGroup] = []
    for title, group in groups:
        lines: dict[str, list[str]] = {}
        for command in group:
            lines.setdefault(command.help or command.text, []).extend(command.shown_keys)
        merged.append((title, [(" ".join(keys), text) for text, keys in lines.items()]))
    return merged
