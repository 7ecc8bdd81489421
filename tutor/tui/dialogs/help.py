"""The help: how to work on an exercise, and all keys."""

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

from tutor.tui.commands import EDITOR_KEYS, GROUPS, TERMINAL_KEYS, Command
from tutor.tui.dialogs.dialog import Dialog

_INTRODUCTION = (
    "Read the lesson, start, edit, run, check. A failure tells you the next step.\n"
    "In the editor, letters type text: leave it with Esc; a terminal with Ctrl+]. The F keys work everywhere."
)

_EVERYWHERE = (
    ("Ctrl+P", "Find any action, lesson, or text"),
    ("Tab", "Move between the panels"),
)

KeyGroup = tuple[str, Sequence[tuple[str, str]]]
"""A title, and (keys, what they do) pairs."""

KEYS_WIDTH = 10
"""Width of the column of keys, in cells."""

LEFT_GROUPS = 3
"""Number of command groups in the left column."""

TWO_COLUMNS_MIN_WIDTH = 116
"""Minimum screen width, in columns, for two columns of groups."""


class KeyTable(Widget):
    """Groups of keys and what they do, with long descriptions wrapped and indented."""

    DEFAULT_CSS = "KeyTable { height: auto; }"

    def __init__(self, *groups: KeyGroup) -> None:
        super().__init__()
        self._groups = groups

    def render(self) -> Content:
        """Render for the current width."""
        return self._text(self.content_size.width)

    def get_content_height(self, container: Size, viewport: Size, width: int) -> int:
        """Return the number of lines at this width."""
        return self._text(width).plain.count("\n") + 1

    def _text(self, width: int) -> Content:
        parts: list[Content | str | tuple[str, str]] = []
        for title, keys in self._groups:
            parts += ["\n\n" if parts else "", (title, "bold $primary")]
            for key, text in keys:
                first, *rest = wrap(text, max(20, width - KEYS_WIDTH)) or [""]
                parts += ["\n", (f"{key:<{KEYS_WIDTH - 1}} ", "bold $accent"), first]
                parts += [f"\n{' ' * KEYS_WIDTH}{line}" for line in rest]
        return Content.assemble(*parts)


class HelpScreen(Dialog[None]):
    """Generated from the table of commands, so it is never out of date."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("question_mark", "close", show=False),
        Binding("q", "close", show=False),
    ]

    def compose(self) -> ComposeResult:
        with VerticalScroll(classes="window") as window:
            window.border_title = "Help"
            window.border_subtitle = "Esc closes"
            yield Static(_INTRODUCTION, classes="dialog-text")
            with Container(id="help-columns"):
                yield KeyTable(*_merge_keys(GROUPS[:LEFT_GROUPS]), ("In the editor", EDITOR_KEYS))
                yield KeyTable(
                    ("Everywhere", _EVERYWHERE), *_merge_keys(GROUPS[LEFT_GROUPS:]), ("In a terminal", TERMINAL_KEYS)
                )

    def on_resize(self, event: events.Resize) -> None:
        """Use two columns if there is room."""
        self.set_class(event.size.width >= TWO_COLUMNS_MIN_WIDTH, "-two")


def _merge_keys(groups: Sequence[tuple[str, tuple[Command, ...]]]) -> list[KeyGroup]:
    """Merge commands with the same help text into one line, with all their keys."""
    merged: list[KeyGroup] = []
    for title, group in groups:
        lines: dict[str, list[str]] = {}
        for command in group:
            lines.setdefault(command.help or command.text, []).extend(command.shown_keys)
        merged.append((title, [(" ".join(keys), text) for text, keys in lines.items()]))
    return merged
