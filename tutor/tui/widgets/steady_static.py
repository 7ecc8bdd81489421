"""A text of which most updates say what it says already."""

from __future__ import annotations

from textual.content import Content
from textual.visual import VisualType
from textual.widgets import Static


class SteadyStatic(Static):
    """A Static that an update with the text that it shows leaves alone: else each lays out and paints the whole screen.

    A running node brings such updates with each line of its log and each look at its graph.
    """

    def update(self, content: VisualType = "", *, layout: bool = True) -> None:
        """Show this."""
        if not _same(content, self.content):
            super().update(content, layout=layout)


def _same(one: VisualType, other: VisualType) -> bool:
    if isinstance(one, Content) and isinstance(other, Content):
        return one.is_same(other)
    return isinstance(one, str) and isinstance(other, str) and one == other
