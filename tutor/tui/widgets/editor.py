"""The editor for one Python file."""

from __future__ import annotations

import re
from pathlib import Path
from typing import ClassVar

from rich.style import Style
from textual import events
from textual.binding import Binding, BindingType
from textual.strip import Strip
from textual.theme import Theme
from textual.widgets import TextArea
from textual.widgets.text_area import TextAreaTheme

from tutor.tui.commands import CANCEL, CHECK, FIND, FIND_NEXT, HELP, PAGE_LIVE, RESTART, RUN, SAVE, STOP, panel_bindings
from tutor.tui.messages import EditorLeft
from tutor.tui.themes import DARK, LIGHT
from tutor.tui.widgets.diffing import same_line

_INDENT = 4

_CAPTURES = {
    "keyword": "keyword keyword.function keyword.return keyword.operator include conditional repeat exception",
    "string": "string string.special",
    "number": "number float boolean constant.builtin",
    "comment": "comment",
    "name": "function function.call method method.call attribute",
    "type": "type type.class type.builtin constructor function.builtin",
}
"""The tree-sitter captures that each colour of the theme is for."""


def _editor_theme(theme: Theme) -> TextAreaTheme:
    colours = {ink: theme.variables[f"code-{ink}"] for ink in _CAPTURES}
    styles = {
        name: Style(color=colours[ink], italic=ink == "comment" or None)
        for ink, names in _CAPTURES.items()
        for name in names.split()
    }
    return TextAreaTheme(name=theme.name, syntax_styles=styles)


class CodeEditor(TextArea):
    """Esc leaves the editor, so that single keys are commands again instead of text."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "leave", "Commands", show=True, key_display="Esc"),
        *panel_bindings(SAVE, FIND, RUN, RESTART, STOP, CHECK, CANCEL, HELP, shown_key=1),
        *panel_bindings(FIND_NEXT, PAGE_LIVE, shown_key=1, show=False),  # F7 is bound differently in TextArea
        Binding("ctrl+a", "select_all", "Select all", show=False),
        Binding("ctrl+home", "go_to_start", "To the beginning", show=False),
        Binding("ctrl+end", "go_to_end", "To the end", show=False),
        Binding("ctrl+shift+home", "go_to_start(True)", "Select to the beginning", show=False),
        Binding("ctrl+shift+end", "go_to_end(True)", "Select to the end", show=False),
    ]
    DEFAULT_CSS = """
    CodeEditor {
        border: none;
        padding: 0;
        background: $surface;
        color: $foreground;
        height: 1fr;
        scrollbar-size: 1 1;
        &:focus { border: none; }
        & .text-area--gutter { color: $quiet; background: $surface; }
        & .text-area--cursor-gutter { color: $primary; background: $panel; text-style: bold; }
        & .text-area--cursor-line { background: $panel; }
        & .text-area--cursor { color: $background; background: $primary; }
        & .text-area--matching-bracket { background: $line; text-style: bold; }
        & .text-area--selection { background: $block-cursor-background; }
    }
    """

    def __init__(self, path: Path, text: str) -> None:
        super().__init__(
            text,
            language="python",
            tab_behavior="indent",
            soft_wrap=False,
            show_line_numbers=True,
        )
        self.path = path
        self.saved_text = self.text
        """The editor's text when it last equalled the file."""

    def on_mount(self) -> None:
        for theme in (DARK, LIGHT):
            self.register_theme(_editor_theme(theme))
        self._follow_theme()
        self.watch(self.app, "theme", self._follow_theme, init=False)

    def _follow_theme(self) -> None:
        self.theme = LIGHT.name if self.app.theme == LIGHT.name else DARK.name

    @property
    def changed(self) -> bool:
        """Whether there are unsaved edits."""
        return self.text != self.saved_text

    def take(self, text: str) -> None:
        """Load a new version of the file; the cursor stays on its line, and undo brings the old version back."""
        if text != self.text:
            row, column = self.cursor_location
            row, top = same_line(self.text, text, row), self.scroll_offset
            self.history.checkpoint()
            self.replace(text, (0, 0), self.document.end)
            self.history.checkpoint()
            row = min(row, self.document.line_count - 1)
            self.move_cursor((row, min(column, len(self.document[row]))))
            self.scroll_to(top.x, top.y, animate=False)
        self.saved_text = self.text

    def go_to(self, line: int) -> None:
        """Move the cursor to the first character of a line (from 1) that is not blank."""
        row = max(0, min(line, self.document.line_count) - 1)
        text = self.document[row]
        self.move_cursor((row, len(text) - len(text.lstrip())), center=True)

    def render_line(self, y: int) -> Strip:
        """Return a line; blank once the editor is removed: it may be painted until the next layout, without styles."""
        return super().render_line(y) if self.is_attached else Strip.blank(self.size.width)

    def on_key(self, event: events.Key) -> None:
        """Indent as Python code needs it; leave on Esc."""
        if event.key == "escape":
            self.action_leave()
        elif event.key == "enter":
            self._insert("\n" + self._indentation())
        elif event.key == "backspace" and (width := self._indent_before()):
            row, column = self.cursor_location
            self.delete((row, column - width), (row, column))
        else:
            return
        event.stop()
        event.prevent_default()

    def action_leave(self) -> None:
        """Ask the page to take the focus back."""
        self.post_message(EditorLeft())

    def action_go_to_start(self, select: bool = False) -> None:
        """Move to the beginning of the file."""
        self.move_cursor((0, 0), select=select)

    def action_go_to_end(self, select: bool = False) -> None:
        """Move to the end of the file."""
        self.move_cursor(self.document.end, select=select)

    def _insert(self, text: str) -> None:
        start, end = self.selection
        self._replace_via_keyboard(text, start, end)

    def _indentation(self) -> str:
        """Return the next line's indentation: deeper after `:` or an open bracket, less after `return` and the like."""
        row, column = min(self.selection.start, self.selection.end)
        before = self.document[row][:column]
        indent = before[: len(before) - len(before.lstrip())]
        code = before.split("#")[0].rstrip()
        if code.endswith((":", "(", "[", "{")):
            return indent + " " * _INDENT
        if re.match(r"\s*(return|pass|break|continue|raise)\b", code) and len(indent) >= _INDENT:
            return indent[:-_INDENT]
        return indent

    def _indent_before(self) -> int:
        """Return how many spaces Backspace removes: back to the tab stop if only spaces precede the cursor, else 0."""
        row, column = self.cursor_location
        before = self.document[row][:column]
        if not self.selection.is_empty or not before or before.strip(" "):
            return 0
        return (column - 1) % _INDENT + 1
