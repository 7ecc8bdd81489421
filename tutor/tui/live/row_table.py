"""The lists of the live page."""

from __future__ import annotations

from rich.text import Text
from textual.widgets import DataTable


class RowTable(DataTable[Text]):
    """A table whose cursor is a whole row."""

    def __init__(self, id: str) -> None:
        super().__init__(id=id, cursor_type="row", cell_padding=1)

    def watch_has_focus(self, _has_focus: bool) -> None:
        """Colour the cursor a frame later: a table has many styles, and what a key shows need not wait for them."""
        self.call_after_refresh(self.update_node_styles)
