"""What has come on a topic, message after message, as `ros2 topic echo` writes it."""

from __future__ import annotations

from collections.abc import Sequence

from rich.cells import cell_len
from textual import events
from textual.geometry import Size

from tutor.tui.widgets.line_view import LineView


class EchoView(LineView):
    """Follows the newest message, unless the learner has scrolled up; End follows again."""

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self._shown: tuple[str, int] = ("", 0)
        self._following = True

    def show_lines(self, topic: str, lines: Sequence[str], came: int) -> None:
        """Show these lines of a topic: the last ones of the `came` lines that there have been so far."""
        if (topic, came) == self._shown:
            return
        (before, had), self._shown = self._shown, (topic, came)
        same = before == topic and had <= came
        self._following = not same or self.is_vertical_scroll_end or not self.rows
        gone = 0 if self._following else max(0, (came - len(lines)) - (had - len(self.rows)))
        self.rows = [((line, ""),) for line in lines]
        self.virtual_size = Size(max(map(cell_len, lines), default=0), len(lines))
        if self._following:
            self.scroll_end(animate=False, immediate=True, force=True, x_axis=False)
        elif gone:  # the oldest lines are forgotten: what is looked at stays where it is
            self.scroll_to(y=self.scroll_offset.y - gone, animate=False, immediate=True)
        self.refresh()

    def on_resize(self, event: events.Resize) -> None:
        """Stay at the newest message, where that is what is looked at."""
        if self._following:
            self.scroll_end(animate=False, immediate=True, force=True, x_axis=False)
