"""An app base class that shows foreign text as plain text: no markup, and no terminal control sequences."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rich.segment import Segment
from textual.app import App
from textual.color import Color
from textual.filter import LineFilter

from tutor.terminal_text import strip_controls


class _ControlStripper(LineFilter):
    """The last step before the terminal: strips control characters from every line painted."""

    def apply(self, segments: list[Segment], background: Color) -> list[Segment]:
        if all(text.isprintable() for text, _, _ in segments):
            return segments
        return [Segment(strip_controls(text), style, control) for text, style, control in segments]


_CONTROL_STRIPPER = _ControlStripper()


class TextApp[Result](App[Result]):
    """The base class of the app."""

    def get_line_filters(self) -> Sequence[LineFilter]:
        """Return Textual's filters, with ours last."""
        return [*super().get_line_filters(), _CONTROL_STRIPPER]

    def notify(self, message: str, **options: Any) -> None:
        """Show a toast; its text is never parsed as markup."""
        super().notify(message, **{**options, "markup": False})
