"""A list of rows, one of which is chosen with the arrows, Home and End."""

from __future__ import annotations

from typing import ClassVar

from textual.binding import Binding, BindingType
from textual.widgets import ListView


class RowList(ListView):
    """Home and End choose the first and the last row, where Textual's own only scrolls."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("home", "first", show=False),
        Binding("end", "last", show=False),
    ]

    def action_first(self) -> None:
        """Choose the first row that can be chosen."""
        self._choose(range(len(self)))

    def action_last(self) -> None:
        """Choose the last one."""
        self._choose(range(len(self) - 1, -1, -1))

    def _choose(self, order: range) -> None:
        self.index = next((n for n in order if not self.children[n].disabled), None)
