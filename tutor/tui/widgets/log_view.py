"""The log of the running node: coloured by level, wrapped to the width, with links from tracebacks to the code."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import ClassVar

from rich.cells import cell_len, chop_cells
from textual import events
from textual.binding import BindingType
from textual.message import Message

from tutor.judge.trace import Level
from tutor.tui import commands
from tutor.tui.commands import panel_bindings
from tutor.tui.loglines import LogLine
from tutor.tui.messages import GoToLine
from tutor.tui.widgets.line_view import LineView, Piece, Row

_MAX_UNBROKEN_CELLS = 16
"""A piece of a line of at most this many cells is moved to the next row whole instead of being broken."""

_NAMES_MIN_WIDTH = 64
"""From this many columns on, each line names its node, even if all lines are from the same one."""


class LogView(LineView):
    """Follows the end of the log, even while hidden, unless the learner has scrolled up or paused it."""

    class Followed(Message):
        """The view has begun or stopped following the end."""

    BINDINGS: ClassVar[list[BindingType]] = panel_bindings(commands.RUN, commands.STOP)
    COMPONENT_CLASSES: ClassVar[set[str]] = {
        f"line--{kind}" for kind in ("quiet", "name", "debug", "info", "warn", "error", "fatal", "link")
    }
    DEFAULT_CSS = """
    LogView {
        & > .line--quiet { color: $quiet; }
        & > .line--name { color: $code-type; }
        & > .line--debug { color: $quiet; }
        & > .line--info { color: $good; }
        & > .line--warn { color: $warn; }
        & > .line--error { color: $bad; }
        & > .line--fatal { color: $bad; text-style: bold reverse; }
        & > .line--link { color: $accent; text-style: underline; }
    }
    """

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self.following = True
        self.own: Sequence[Path] = ()
        """The learner's own files: lines that name one of them can be clicked."""
        self._lines: Sequence[LogLine] = ()
        self._head: Sequence[Row] = ()
        self._tail: Row = ()
        self._locations: list[tuple[Path, int] | None] = []

    def show_log(self, lines: Sequence[LogLine], head: Sequence[Row] = (), tail: Row = ()) -> None:
        """Show these lines; `head` and `tail` are rows of the tutor's own before and after them."""
        self._lines, self._head, self._tail = lines, head, tail
        self._lay_out()

    def watch_scroll_y(self, old_value: float, new_value: float) -> None:
        """Stop following when the learner scrolls up; follow again once they are at the end."""
        super().watch_scroll_y(old_value, new_value)
        if self.following != (at_end := self.is_vertical_scroll_end):
            self.following = at_end
            self.post_message(self.Followed())

    def on_resize(self, event: events.Resize) -> None:
        """Wrap the log to the new width."""
        self._lay_out()

    def on_click(self, event: events.Click) -> None:
        """Go from a line of a traceback to its place in the code."""
        row = event.y + self.scroll_offset.y
        if 0 <= row < len(self._locations) and (location := self._locations[row]) is not None:
            event.stop()
            self.post_message(GoToLine(*location))

    def _lay_out(self) -> None:
        width = max(20, self.scrollable_content_region.width)
        rows: list[Row] = []
        locations: list[tuple[Path, int] | None] = []

        def add(pieces: Row, location: tuple[Path, int] | None = None) -> None:
            for folded in _wrapped(pieces, width):
                rows.append(folded)
                locations.append(location)

        for row in self._head:
            add(row)
        # In a narrow view, a name that all lines share is the first thing to drop.
        named = width >= _NAMES_MIN_WIDTH or len({line.name for line in self._lines if line.level is not None}) > 1
        for line in self._lines:
            location = line.location if line.location is not None and line.location[0] in self.own else None
            add(_coloured(line, linked=location is not None, named=named), location)
        if self._tail:
            add(self._tail)
        self._locations = locations
        self.show_rows(rows)
        if self.following:
            # Forced: without a scrollbar laid out, Textual would not scroll at all.
            self.scroll_end(animate=False, immediate=True, force=True, x_axis=False)


def _coloured(line: LogLine, *, linked: bool, named: bool) -> Row:
    if line.level is not None:
        at = time.strftime("%H:%M:%S", time.localtime(line.stamp))
        kind = line.level.name.lower()
        message_kind = "" if line.level is Level.INFO else kind
        head = (f" {line.level.name:<5} ", kind)
        name = f"{line.name}  " if named else ""
        return (head, (f" {at}  ", "quiet"), (name, "name"), (line.message, message_kind))
    if not line.stderr:
        return ((" print  ", "quiet"), (line.text, ""))
    if linked:
        return ((" stderr ", "warn"), (line.text, "link"), ("  ← g or click", "quiet"))
    return ((" stderr ", "warn"), (line.text, "error" if line.error else ""))


def _wrapped(pieces: Row, width: int) -> Iterable[Row]:
    """Fold one line into rows, the second and later ones indented. A short piece moves to the next row whole."""
    if sum(cell_len(text) for text, _ in pieces) <= width:
        return [pieces]
    indent = 8
    rows: list[list[Piece]] = [[]]
    room = width
    for text, kind in pieces:
        while text:
            if cell_len(text) <= room:
                rows[-1].append((text, kind))
                room -= cell_len(text)
                break
            moves_whole = room < width - indent and cell_len(text) <= _MAX_UNBROKEN_CELLS
            head = chop_cells(text, room)[0] if room > 1 and not moves_whole else ""
            if head:
                rows[-1].append((head, kind))
            text = text[len(head) :]
            rows.append([(" " * indent, "")])
            room = width - indent
    return [tuple(row) for row in rows]
