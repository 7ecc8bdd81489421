"""The plot of one numeric field over time."""

from __future__ import annotations

from collections.abc import Sequence

from textual.content import Content
from textual.widget import Widget

from tutor.tui.live.plot import Point, draw

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
        self.span_s = SPANS_S[1]

    def show(self, points: Sequence[Point], now: float, end: str = "now") -> None:
        """Show these; `now` is at the right edge, and named `end`."""
        self.points, self.now, self.end = points, now, end
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
        plot = draw(self.points, width, height, self.now, self.span_s, self.end)
        rows = [Content.assemble((axis, "$quiet"), (dots, "$busy")) for axis, dots in plot.rows]
        return Content("\n").join([*rows, Content.styled(plot.below, "$quiet")])
