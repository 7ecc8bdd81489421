"""An app on whose screen foreign text is only text: no markup, and nothing that the terminal would obey."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rich.segment import Segment
from textual.app import App
from textual.color import Color
from textual.filter import LineFilter

from tutor.terminal_text import strip_controls


class _TextOnly(LineFilter):
    """The border to the terminal: every line that is strip_controls passes it."""

    def apply(self, segments: list[Segment], background: Color) -> list[Segment]:
        if all(text.isprintable() for text, _, _ in segments):
            return segments
        return [Segment(strip_controls(text), style, control) for text, style, control in segments]


_TEXT_ONLY = _TextOnly()


class TextApp[Result](App[Result]):
    """The base of the app."""

    def get_line_filters(self) -> Sequence[LineFilter]:
        """Textual's, and ours last."""
        return [*super().get_line_filters(), _TEXT_ONLY]

    def notify(self, message: str, **options: Any) -> None:
        """Show a note; whatever it names is not markup."""
        super().notify(message, **{**options, "markup": False})
