"""A Static for text that is updated often but rarely changes."""

from __future__ import annotations

from textual.content import Content
from textual.visual import VisualType
from textual.widgets import Static


class SteadyStatic(Static):
    """A Static that ignores updates to the text it already shows: each would lay out and repaint the whole screen.

    A running node causes such updates with each line of its log and each change of its graph.
    """

    def update(self, content: VisualType = "", *, layout: bool = True) -> None:
        """Show this text, unless it is shown already."""
        if not _same(content, self.content):
            super().update(content, layout=layout)


def _same(one: VisualType, other: VisualType) -> bool:
    if isinstance(one, Content) and isinstance(other, Content):
        return one.is_same(other)
    return isinstance(one, str) and isinstance(other, str) and one == other
