"""The lists of the live page."""

from __future__ import annotations

from rich.text import Text
from textual import events
from textual.widgets import DataTable


class RowTable(DataTable[Text]):
    """A table whose cursor is a whole row.

    The cursor takes the colours of the focus a frame later, and only where the table can be seen: a table has many
    styles, and new ones make it redraw every cell. What a key shows need not wait for them.
    """

    def __init__(self, id: str) -> None:
        super().__init__(id=id, cursor_type="row", cell_padding=1)
        self._styled_for_focus = False

    def watch_has_focus(self, _has_focus: bool) -> None:
        """Take other colours, soon."""
        self.call_after_refresh(self._style_for_focus)

    def on_show(self, _event: events.Show) -> None:
        """Take those that it could not take unseen."""
        self.call_after_refresh(self._style_for_focus)

    def _style_for_focus(self) -> None:
        if self.has_focus != self._styled_for_focus and self.is_on_screen:
            self._styled_for_focus = self.has_focus
            self.update_node_styles()
