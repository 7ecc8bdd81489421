"""A scrolling view of many lines of coloured text; the base of the code view and the log."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import zip_longest

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from textual.geometry import Region, Size
from textual.reactive import Reactive
from textual.scroll_view import ScrollView
from textual.selection import Selection
from textual.strip import Strip

Piece = tuple[str, str]
"""A text and its kind: a component class without its prefix, or empty for plain text."""

Row = tuple[Piece, ...]


class LineView(ScrollView, can_focus=True):
    """Shows rows of pieces. Subclasses declare the kinds as component classes `line--KIND`, which follow the theme."""

    DEFAULT_CSS = """
    LineView {
        background: $surface;
        color: $foreground;
        scrollbar-gutter: stable;
        scrollbar-size: 1 1;
    }
    """

    virtual_size = Reactive(Size(0, 0), repaint=False)
    """As Textual's, but a new size lays out nothing: only the scrollbars depend on it, never the size of the view."""

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self.rows: Sequence[Row] = ()
        self.margins: Sequence[Piece] = ()
        """One margin per row, fixed at the left while the row scrolls sideways; all of one width. Empty for none."""
        self._base = Style()

    def show_rows(self, rows: Sequence[Row], margins: Sequence[Piece] = ()) -> None:
        """Replace the rows; the scroll position stays."""
        changed = [y for y, (old, new) in enumerate(zip_longest(self.rows, rows)) if old != new]
        if margins != self.margins:
            self.refresh()
        elif changed:  # repaint no others: most rows stay the same while values arrive fast
            self.refresh_lines(changed[0], changed[-1] - changed[0] + 1)
        self.rows, self.margins = rows, margins
        widest = max((sum(cell_len(text) for text, _ in row) for row in rows), default=0)
        self.virtual_size = Size(widest + self._margin_width, len(rows))

    def watch_virtual_size(self, size: Size) -> None:
        """Update the scrollbars."""
        if self.container_size:  # else it is not laid out yet
            self._scroll_update(size)

    @property
    def plain(self) -> str:
        """The text without margins."""
        return "\n".join("".join(text for text, _ in row) for row in self.rows)

    @property
    def _margin_width(self) -> int:
        return cell_len(self.margins[0][0]) if self.margins else 0

    def render_lines(self, crop: Region) -> list[Strip]:
        """Render some rows, computing their common style once: it takes longer than rendering a row."""
        self._base = self.rich_style
        return super().render_lines(crop)

    def render_line(self, y: int) -> Strip:
        """Render one row of the screen."""
        left, top = self.scroll_offset
        width, line = self.size.width, top + y
        base = self._base
        if line >= len(self.rows):
            return Strip.blank(width, base)
        text = Strip([Segment(text, self._style(kind, base)) for text, kind in self.rows[line]])
        if (selection := self.text_selection) is not None:
            text = self._selected(text, selection, line)
        body = width - self._margin_width
        text = text.crop_extend(left, left + body, base).apply_offsets(left, line)
        if not self.margins:
            return text
        number, kind = self.margins[line]
        return Strip.join([Strip([Segment(number, self._style(kind, base))]), text])

    def _style(self, kind: str, base: Style) -> Style:
        return base + self.get_component_rich_style(f"line--{kind}", partial=True) if kind else base

    def _selected(self, text: Strip, selection: Selection, line: int) -> Strip:
        if (span := selection.get_span(line)) is None:
            return text
        start, end = span
        end = text.cell_length if end == -1 else end
        before, chosen, after = (text.crop(a, b) for a, b in ((0, start), (start, end), (end, None)))
        return Strip.join(
            [before, chosen.apply_style(self.screen.get_component_rich_style("screen--selection")), after]
        )

    def get_selection(self, selection: Selection) -> tuple[str, str] | None:
        """The selected text, for the clipboard."""
        return selection.extract(self.plain), "\n"

    def selection_updated(self, selection: Selection | None) -> None:
        """Repaint with the new selection."""
        self.refresh()
