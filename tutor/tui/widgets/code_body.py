"""The part of the code pane that shows code, and scrolls it."""

from __future__ import annotations

from typing import ClassVar

from textual.binding import Binding, BindingType
from textual.containers import Container
from textual.widget import Widget


class CodeBody(Container, can_focus=True):
    """Container of the editors. It has the focus while single keys are commands: arrows scroll, Enter starts typing."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter", "screen.do('edit')", "Edit", show=False),
        Binding("up", "scroll_lines(-1)", show=False),
        Binding("down", "scroll_lines(1)", show=False),
        Binding("pageup", "scroll_pages(-1)", show=False),
        Binding("pagedown", "scroll_pages(1)", show=False),
        Binding("home", "scroll_edge(False)", show=False),
        Binding("end", "scroll_edge(True)", show=False),
    ]

    @property
    def _editor(self) -> Widget | None:
        return next((child for child in self.children if child.display), None)

    def action_scroll_lines(self, lines: int) -> None:
        """Scroll by this many lines, down if positive."""
        if self._editor is not None:
            self._editor.scroll_relative(y=lines, animate=False)

    def action_scroll_pages(self, pages: int) -> None:
        """Scroll by this many pages, down if positive."""
        self.action_scroll_lines(pages * max(1, self.size.height - 1))

    def action_scroll_edge(self, down: bool) -> None:
        """Scroll to the top or the bottom."""
        if self._editor is not None:
            (self._editor.scroll_end if down else self._editor.scroll_home)(animate=False)
