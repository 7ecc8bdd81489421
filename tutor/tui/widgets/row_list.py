"""A list whose chosen row moves with the arrows, Home and End."""

from __future__ import annotations

from typing import ClassVar

from textual.binding import Binding, BindingType
from textual.widgets import ListView


class RowList(ListView):
    """A ListView in which Home and End choose the first and last row; Textual's own only scrolls."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("home", "first", show=False),
        Binding("end", "last", show=False),
    ]

    def action_first(self) -> None:
        """Choose the first enabled row."""
        self._choose(range(len(self)))

    def action_last(self) -> None:
        """Choose the last enabled row."""
        self._choose(range(len(self) - 1, -1, -1))

    def _choose(self, order: range) -> None:
        self.index = next((n for n in order if not self.children[n].disabled), None)
