"""A lesson's code and examples: a line too long for the page goes on in the next row, instead of out of sight."""

from __future__ import annotations

from itertools import accumulate

from textual.app import ComposeResult
from textual.content import Content
from textual.widgets import Markdown
from textual.widgets.markdown import MarkdownBlock, MarkdownFence

from tutor.tui.widgets.wrapped import WrappedText

_HANG = 4
"""By how many cells the rest of a line is indented more than the line."""


class LessonFence(MarkdownFence):
    """A fenced block whose lines are wrapped as the rest of the app wraps code, and copied as they were."""

    DEFAULT_CSS = """
    LessonFence { overflow: hidden; }
    LessonFence > WrappedText { width: 1fr; padding: 1 1; }
    """

    def compose(self) -> ComposeResult:
        yield WrappedText(hang=_HANG).with_text(self._highlighted_code)

    def set_content(self, content: Content) -> None:
        """Show other code."""
        self._content = content
        for text in self.query(WrappedText):
            text.with_text(content)

    def line_at(self, screen_x: int, screen_y: int) -> int | None:
        """Return the number (from 0) of the line of code shown at a position on the screen; None beside the text."""
        text = self.query_one(WrappedText)
        if not text.content_region.contains(screen_x, screen_y):
            return None
        ends = accumulate(text.heights)
        row = screen_y - text.content_region.y
        return next((line for line, end in enumerate(ends) if row < end), None)


class LessonMarkdown(Markdown):
    """Markdown with such blocks."""

    def get_block_class(self, block_name: str) -> type[MarkdownBlock]:
        """Return the widget of a kind of block."""
        return LessonFence if block_name in ("fence", "code_block") else super().get_block_class(block_name)
