"""The log of the running node, its levels coloured, wrapped to the width."""

from __future__ import annotations

import re
import time
from collections.abc import Iterable, Sequence
from typing import ClassVar

from rich.cells import cell_len, chop_cells
from textual import events

from tutor.judge.trace import OutputLine
from tutor.tui.widgets.line_view import LineView, Piece, Row

_ROS_LOG = re.compile(r"\[(DEBUG|INFO|WARN|ERROR|FATAL)\] \[(\d+\.\d+)\] \[([^\]]*)\]: ?(.*)")
_CONTROL = re.compile(r"\x1b\[[0-9;?]*[ -/]*[@-~]|[\x00-\x08\x0b-\x1f\x7f]")


class LogView(LineView):
    """Follows the end of the log, unless the learner has scrolled up."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        f"line--{kind}" for kind in ("quiet", "name", "debug", "info", "warn", "error", "fatal")
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
    }
    """

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self.lines: Sequence[OutputLine] = ()
        self.dropped = 0
        self.tail: Row = ()

    def show_log(self, lines: Sequence[OutputLine], dropped: int = 0, tail: Row = ()) -> None:
        """Show these lines; `dropped` says how many in the middle were not kept, `tail` is our own last word."""
        self.lines, self.dropped, self.tail = lines, dropped, tail
        self._lay_out()

    def on_resize(self, event: events.Resize) -> None:
        """Wrap anew."""
        self._lay_out()

    def _lay_out(self) -> None:
        at_end = self.is_vertical_scroll_end or not self.rows
        width = max(20, self.scrollable_content_region.width)
        pieces = [_coloured(line) for line in self.lines]
        if self.dropped:
            pieces.insert(0, ((f"({self.dropped} lines of a flood are not shown)", "quiet"),))
        if self.tail:
            pieces.append(self.tail)
        self.show_rows([row for line in pieces for row in _wrapped(line, width)])
        if at_end:
            self.scroll_end(animate=False, immediate=True, x_axis=False)


def _coloured(line: OutputLine) -> Row:
    text = _CONTROL.sub("", line.text.expandtabs(4))
    if found := _ROS_LOG.match(text):
        level, stamp, name, said = found.groups()
        at = time.strftime("%H:%M:%S", time.localtime(float(stamp)))
        kind = level.lower()
        loud = kind if kind in ("warn", "error", "fatal") else "debug" if kind == "debug" else ""
        return ((f" {level:<5} ", kind), (f" {at}  ", "quiet"), (f"{name}  ", "name"), (said, loud))
    if line.stream == "stderr":
        return ((" stderr ", "warn"), (text, "error" if _is_error(text) else ""))
    return ((" print  ", "quiet"), (text, ""))


def _is_error(text: str) -> bool:
    return text.startswith("Traceback ") or bool(re.match(r"[\w.]*(Error|Exception|Interrupt)\b", text))


def _wrapped(pieces: Row, width: int) -> Iterable[Row]:
    """Fold one line into rows; the second and further ones are set in."""
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
            head = chop_cells(text, room)[0] if room > 1 else ""
            if head:
                rows[-1].append((head, kind))
            text = text[len(head) :]
            rows.append([(" " * indent, "")])
            room = width - indent
    return [tuple(row) for row in rows]
