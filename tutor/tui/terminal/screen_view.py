"""Draws the screen of one terminal as the emulator has it: text, colours, the cursor, and what has left the screen."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, ClassVar

from rich.segment import Segment
from rich.style import Style
from textual.geometry import Region
from textual.message import Message
from textual.selection import Selection
from textual.strip import Strip
from textual.timer import Timer
from textual.widget import Widget

from tutor.tui.terminal.styled_rows import styled_row

if TYPE_CHECKING:
    from tutor.tui.terminal.emulator import Emulator

FLOOD_INTERVAL_S, TYPING_INTERVAL_S = 1 / 10, 1 / 30
"""Time between two paints while output arrives all the time: in general, and just after a key."""

TYPING_S = 0.3


class ScreenView(Widget):
    """Draws the emulator's screen: what has changed, and no more often than it helps."""

    DEFAULT_CSS = """
    ScreenView { height: 1fr; background: $surface; color: $foreground; }
    ScreenView > .terminal--cursor { background: $foreground; color: $surface; }
    ScreenView > .terminal--away { background: $line; color: $foreground; }
    """
    COMPONENT_CLASSES: ClassVar[set[str]] = {"terminal--cursor", "terminal--away"}

    class Scrolled(Message):
        """The viewport has been scrolled."""

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self.emulator: Emulator | None = None
        self.typed_at = 0.0
        """When the last key was pressed: its effect is painted sooner than other output."""
        self._texts: list[str] = []
        self._strips: list[Strip] = []
        self._blank_style = Style()
        self._cursor: tuple[int, int] | None = None
        self._timer: Timer | None = None
        self._painted_at = 0.0

    @property
    def plain(self) -> str:
        """The text on the screen."""
        return "\n".join(strip.text.rstrip() for strip in self._strips)

    @property
    def rows_below(self) -> int:
        """How far the learner has scrolled back, in rows."""
        return 0 if self.emulator is None else self.emulator.rows_below

    def scroll_rows(self, rows: int | None) -> None:
        """Scroll by so many rows, up if negative; None: to the end."""
        if self.emulator is not None:
            self.emulator.scroll(rows)
            self.paint()
            self.post_message(self.Scrolled())

    def on_show(self) -> None:
        """Catch up with what was written while the terminal was not shown."""
        self.paint()

    def schedule_paint(self) -> None:
        """Paint soon: at once after a pause, else when it is time again."""
        if self._timer is not None or not self.is_on_screen:
            return
        now = time.monotonic()
        interval = TYPING_INTERVAL_S if now - self.typed_at < TYPING_S else FLOOD_INTERVAL_S
        if (wait := self._painted_at + interval - now) <= 0:
            self.paint()
        else:
            self._timer = self.set_timer(wait, self.paint)

    def paint(self) -> None:
        """Take the screen over from the emulator, and repaint the rows that differ."""
        if self._timer is not None:
            self._timer.stop()
            self._timer = None
        self._painted_at = time.monotonic()
        if self.emulator is None:
            return
        texts, cursor, base = self.emulator.rows(), self.emulator.cursor, self.rich_style
        width = self.emulator.size[0]
        old = self._texts if base == self._blank_style and self._strips and self._strips[0].cell_length == width else []
        changed = {y for y, text in enumerate(texts) if y >= len(old) or old[y] != text}
        self._strips = [
            styled_row(text, width, base) if y in changed else self._strips[y] for y, text in enumerate(texts)
        ]
        if cursor != self._cursor:
            changed |= {place[1] for place in (cursor, self._cursor) if place is not None}
        self._texts, self._cursor, self._blank_style = texts, cursor, base
        if changed:
            first, last = min(changed), max(changed)
            self.refresh(Region(0, first, self.size.width, last - first + 1))

    def notify_style_update(self) -> None:
        """Follow the theme."""
        super().notify_style_update()
        if self.emulator is not None and self.rich_style != self._blank_style:
            self.paint()

    def render_line(self, y: int) -> Strip:
        """Render one row."""
        if y >= len(self._strips):
            return Strip.blank(self.size.width, self.rich_style)
        strip = self._strips[y]
        if (selection := self.text_selection) is not None and (span := selection.get_span(y)) is not None:
            start, end = span[0], strip.cell_length if span[1] == -1 else span[1]
            strip = _restyle(strip, start, end, self.screen.get_component_rich_style("screen--selection"))
        if self._cursor is not None and self._cursor[1] == y:
            x = self._cursor[0]
            width = 2 if len(strip.crop(x, x + 2).text) == 1 else 1
            kind = "terminal--cursor" if self.has_focus else "terminal--away"
            strip = _restyle(strip, x, x + width, self.get_component_rich_style(kind) + Style(reverse=False))
        return strip.adjust_cell_length(self.size.width, self._blank_style).apply_offsets(0, y)

    def get_selection(self, selection: Selection) -> tuple[str, str] | None:
        """The selected text, for the clipboard."""
        return selection.extract(self.plain), "\n"

    def selection_updated(self, selection: Selection | None) -> None:
        """Repaint with the new selection."""
        self.refresh()


def _restyle(strip: Strip, start: int, end: int, style: Style) -> Strip:
    """Return the strip with its cells from `start` to before `end` in another style."""
    before, chosen, after = (strip.crop(a, b) for a, b in ((0, start), (start, end), (end, None)))
    restyled = Strip(Segment.apply_style(list(chosen), post_style=style), chosen.cell_length)
    return Strip.join([before, restyled, after])
