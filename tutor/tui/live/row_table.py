"""The table used for the lists of the live page."""

from __future__ import annotations

from rich.segment import Segment
from rich.style import Style
from rich.text import Text
from textual import events
from textual.coordinate import Coordinate
from textual.widgets import DataTable


class RowTable(DataTable[Text]):
    """A table whose cursor is a whole row.

    The cursor takes on its focus colours one frame late, and only while the table is visible: new styles make a table
    redraw every cell, and the effect of a key press should not wait for that.

    Textual renders all cells again when one has changed; here the others stay as they are.
    """

    def __init__(self, id: str) -> None:
        super().__init__(id=id, cursor_type="row", cell_padding=1)
        self._styled_for_focus = False
        self._rendered: dict[tuple[object, ...], tuple[Text, list[list[Segment]]]] = {}
        """Each cell as last rendered, by place and style."""

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

    def _render_cell(
        self,
        row_index: int,
        column_index: int,
        base_style: Style,
        width: int,
        cursor: bool = False,
        hover: bool = False,
    ) -> list[list[Segment]]:
        if row_index < 0:
            cell = self.ordered_columns[column_index].label
        else:
            cell = self.get_cell_at(Coordinate(row_index, column_index))
        place = (row_index, column_index, base_style, width, cursor, hover, self._show_hover_cursor)
        key = (*place, self._pseudo_class_state)
        known = self._rendered.get(key)
        if known is None or known[0] is not cell:
            lines = super()._render_cell(row_index, column_index, base_style, width, cursor, hover)
            self._rendered[key] = known = (cell, lines)
        return known[1]

    def _clear_caches(self) -> None:
        super()._clear_caches()
        self._rendered.clear()  # the theme, or the columns, may be others
