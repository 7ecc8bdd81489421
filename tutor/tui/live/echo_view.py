"""The messages received on a topic, as `ros2 topic echo` prints them."""

from __future__ import annotations

from collections.abc import Sequence

from rich.cells import cell_len
from textual import events
from textual.geometry import Size

from tutor.tui.widgets.line_view import LineView


class EchoView(LineView):
    """Follows the newest message, unless the learner has scrolled up; End resumes following."""

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self._shown: tuple[str, int] = ("", 0)
        self._following = True

    def show_lines(self, topic: str, lines: Sequence[str], line_count: int) -> None:
        """Show the latest lines of a topic, of `line_count` received so far."""
        if (topic, line_count) == self._shown:
            return
        (previous_topic, previous_count), self._shown = self._shown, (topic, line_count)
        is_same_topic = previous_topic == topic and previous_count <= line_count
        self._following = not is_same_topic or self.is_vertical_scroll_end or not self.rows
        dropped = 0 if self._following else max(0, (line_count - len(lines)) - (previous_count - len(self.rows)))
        self.rows = [((line, ""),) for line in lines]
        self.virtual_size = Size(max(map(cell_len, lines), default=0), len(lines))
        if self._following:
            self.scroll_end(animate=False, immediate=True, force=True, x_axis=False)
        elif dropped:  # the oldest lines were dropped: scroll along, so that the visible ones stay in place
            self.scroll_to(y=self.scroll_offset.y - dropped, animate=False, immediate=True)
        self.refresh()

    def on_resize(self, event: events.Resize) -> None:
        """Stay at the newest message if following."""
        if self._following:
            self.scroll_end(animate=False, immediate=True, force=True, x_axis=False)
