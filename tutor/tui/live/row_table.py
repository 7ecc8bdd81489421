"""The table used for the lists of the live page."""

from __future__ import annotations

from rich.text import Text
from textual import events
from textual.widgets import DataTable


class RowTable(DataTable[Text]):
    """A table whose cursor is a whole row.

    The cursor takes on its focus colours one frame late, and only while the table is visible: new styles make a table
    redraw every cell, and the effect of a key press should not wait for that.
    """

    def __init__(self, id: str) -> None:
        super().__init__(id=id, cursor_type="row", cell_padding=1)
        self._styled_for_focus = False

    def watch_has_focus(self, _has_focus: bool) -> None:
        """Restyle after the next frame."""
        self.call_after_refresh(self._style_for_focus)

    def on_show(self, _event: events.Show) -> None:
        """Catch up on a restyle that was skipped while hidden."""
        self.call_after_refresh(self._style_for_focus)

    def _style_for_focus(self) -> None:
        if self.has_focus != self._styled_for_focus and self.is_on_screen:
            self._styled_for_focus = self.has_focus
            self.update_node_styles()
