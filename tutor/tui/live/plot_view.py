"""The plot of one numeric field over time."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

from textual.content import Content
from textual.widget import Widget

from tutor.tui.live.plot import Point, draw

_COLOURS = {" ": "$busy", "m": "bold $accent", "o": "bold $bad", "b": "$good"}

_SPANS_S = (5.0, 10.0, 30.0, 60.0, 120.0)


class PlotView(Widget):
    """Draws the given points at its own size."""

    DEFAULT_CSS = """
    PlotView { height: 1fr; width: 1fr; background: $surface; }
    """

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self.points: Sequence[Point] = ()
        self.now = 0.0
        self.end = "now"
        self.band: tuple[float, float] | None = None
        self.span_s = _SPANS_S[1]

    def show(
        self, points: Sequence[Point], now: float, end: str = "now", band: tuple[float, float] | None = None
    ) -> None:
        """Show these points; `now` is at the right edge, labelled `end`. `band`: the range the exercise asks for."""
        self.points, self.now, self.end, self.band = points, now, end, band
        self.refresh()

    def zoom(self, by: int) -> None:
        """Show a longer time span, or with a negative `by` a shorter one."""
        index = _SPANS_S.index(self.span_s) + by
        self.span_s = _SPANS_S[max(0, min(len(_SPANS_S) - 1, index))]
        self.refresh()

    def render(self) -> Content:
        """Draw the axes and the line."""
        width, height = self.content_size
        if width < 12 or height < 3:
            return Content("")
        if not self.points:
            return Content.styled("no numbers yet", "$quiet")
        plot = draw(self.points, width, height, self.now, self.span_s, self.end, self.band)
        rows = [
            Content.assemble((axis, "$quiet"), *_coloured_runs(cells, kinds))
            for (axis, cells), kinds in zip(plot.rows, plot.kinds, strict=True)
        ]
        return Content("\n").join([*rows, Content.styled(plot.below, "$quiet")])


def _coloured_runs(cells: str, kinds: str) -> Iterator[tuple[str, str]]:
    """Yield a row's cells in runs of the same colour."""
    index = 0
    for kind, run in itertools.groupby(kinds):
        length = sum(1 for _ in run)
        yield cells[index : index + length], _COLOURS[kind]
        index += length
