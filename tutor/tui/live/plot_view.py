"""The plot of one numeric field over time."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from typing import ClassVar

from rich.segment import Segment
from rich.style import Style
from textual.geometry import Size
from textual.strip import Strip
from textual.widget import Widget

from tutor.tui.live.plot import Point, draw

_KINDS = {" ": "line", "m": "sample", "o": "outside", "b": "band", "a": "axis"}

_SPANS_S = (5.0, 10.0, 30.0, 60.0, 120.0)


class PlotView(Widget):
    """Draws the given points at its own size.

    It makes its strips itself: through Textual's Content, that took a tenth of the work of the whole page.
    """

    ALLOW_SELECT = False
    COMPONENT_CLASSES: ClassVar[set[str]] = {f"plot--{kind}" for kind in _KINDS.values()}
    DEFAULT_CSS = """
    PlotView {
        height: 1fr;
        width: 1fr;
        background: $surface;
        & > .plot--axis { color: $quiet; }
        & > .plot--line { color: $busy; }
        & > .plot--sample { color: $accent; text-style: bold; }
        & > .plot--outside { color: $bad; text-style: bold; }
        & > .plot--band { color: $good; }
    }
    """

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self.points: Sequence[Point] = ()
        self.now = 0.0
        self.end = "now"
        self.band: tuple[float, float] | None = None
        self.span_s = _SPANS_S[1]
        self._drawn: tuple[Size, list[Strip]] | None = None
        """The rows as last drawn, and for which size."""
        self._colours: dict[str, Style] = {}

    def show(
        self, points: Sequence[Point], now: float, end: str = "now", band: tuple[float, float] | None = None
    ) -> None:
        """Show these points; `now` is at the right edge, labelled `end`. `band`: the range the exercise asks for."""
        self.points, self.now, self.end, self.band = points, now, end, band
        self._draw_again()

    def zoom(self, by: int) -> None:
        """Show a longer time span, or with a negative `by` a shorter one."""
        index = _SPANS_S.index(self.span_s) + by
        self.span_s = _SPANS_S[max(0, min(len(_SPANS_S) - 1, index))]
        self._draw_again()

    def notify_style_update(self) -> None:
        """Draw in the new colours."""
        super().notify_style_update()
        self._drawn = None
        self._colours.clear()

    def render_line(self, y: int) -> Strip:
        """Return one row of axes and line."""
        size = self.content_size
        if self._drawn is None or self._drawn[0] != size:
            self._drawn = size, list(self._rows(size))
        rows = self._drawn[1]
        return rows[y] if y < len(rows) else Strip.blank(size.width, self.rich_style)

    def _draw_again(self) -> None:
        self._drawn = None
        self.refresh()

    def _rows(self, size: Size) -> Iterator[Strip]:
        width, height = size
        if width < 12 or height < 3:
            return
        if not self._colours:  # looking them up takes longer than drawing
            self._colours = {
                letter: self.get_component_rich_style(f"plot--{kind}", partial=True) for letter, kind in _KINDS.items()
            }
        base = self.rich_style
        styles = {letter: base + colour for letter, colour in self._colours.items()}
        axis = styles["a"]
        if not self.points:
            yield Strip([Segment("no numbers yet", axis)]).extend_cell_length(width, base)
            return
        plot = draw(self.points, width, height, self.now, self.span_s, self.end, self.band)
        for (edge, cells), kinds in zip(plot.rows, plot.kinds, strict=True):
            yield Strip([Segment(edge, axis), *_coloured_runs(cells, kinds, styles)])
        yield Strip([Segment(plot.below, axis)])


def _coloured_runs(cells: str, kinds: str, styles: dict[str, Style]) -> Iterator[Segment]:
    """Yield a row's cells in runs of the same colour."""
    index = 0
    for kind, run in itertools.groupby(kinds):
        length = sum(1 for _ in run)
        yield Segment(cells[index : index + length], styles[kind])
        index += length
