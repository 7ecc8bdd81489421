"""The plot of one numeric field over time."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

from textual.content import Content
from textual.widget import Widget

from tutor.tui.live.plot import Point, draw

_INKS = {" ": "$busy", "m": "bold $accent", "o": "bold $bad", "b": "$good"}

SPANS_S = (5.0, 10.0, 30.0, 60.0, 120.0)


class PlotView(Widget):
    """Draws what it is given, for the size that there is."""

    DEFAULT_CSS = """
    PlotView { height: 1fr; width: 1fr; background: $surface; }
    """

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self.points: Sequence[Point] = ()
        self.now = 0.0
        self.end = "now"
        self.band: tuple[float, float] | None = None
        self.span_s = SPANS_S[1]

    def show(
        self, points: Sequence[Point], now: float, end: str = "now", band: tuple[float, float] | None = None
    ) -> None:
        """Show these; `now` is at the right edge, and named `end`. `band`: the values that are asked for."""
        self.points, self.now, self.end, self.band = points, now, end, band
        self.refresh()

    def zoom(self, by: int) -> None:
        """Show a longer time, or a shorter one."""
        place = SPANS_S.index(self.span_s) + by
        self.span_s = SPANS_S[max(0, min(len(SPANS_S) - 1, place))]
        self.refresh()

    def render(self) -> Content:
        """The axes and the line."""
        width, height = self.content_size
        if width < 12 or height < 3:
            return Content("")
        if not self.points:
            return Content.styled("no numbers yet", "$quiet")
        plot = draw(self.points, width, height, self.now, self.span_s, self.end, self.band)
        rows = [
            Content.assemble((axis, "$quiet"), *_inked(cells, kinds))
            for (axis, cells), kinds in zip(plot.rows, plot.kinds, strict=True)
        ]
        return Content("\n").join([*rows, Content.styled(plot.below, "$quiet")])


def _inked(cells: str, kinds: str) -> Iterator[tuple[str, str]]:
    """The cells of a row in runs of one colour each."""
    place = 0
    for kind, run in itertools.groupby(kinds):
        length = sum(1 for _ in run)
        yield cells[place : place + length], _INKS[kind]
        place += length
