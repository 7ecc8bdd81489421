"""The output of one command, wrapped to the width; follows the end unless the learner has scrolled up."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from rich.cells import cell_len, chop_cells
from textual import events
from textual.binding import BindingType

from tutor.judge.trace import OutputLine
from tutor.session.node import NodeState, Phase
from tutor.terminal_text import strip_ansi
from tutor.tui.widgets.line_view import LineView, Row

_LEVELS = {"[WARN]": "warn", "[ERROR]": "error", "[FATAL]": "error"}


class OutputView(LineView):
    """Shows a command, its output, and how it ended."""

    BINDINGS: ClassVar[list[BindingType]] = []
    COMPONENT_CLASSES: ClassVar[set[str]] = {f"line--{kind}" for kind in ("quiet", "name", "warn", "error")}
    DEFAULT_CSS = """
    OutputView {
        & > .line--quiet { color: $quiet; }
        & > .line--name { color: $code-type; text-style: bold; }
        & > .line--warn { color: $warn; }
        & > .line--error { color: $bad; }
    }
    """

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self._state: NodeState | None = None
        self._error = ""

    def show_state(self, state: NodeState | None, *, new: bool = False) -> None:
        """Show a command's current state; `new`: a different command, so scroll to its end."""
        self._state = state
        self._lay_out(to_end=new)

    def show_error(self, text: str) -> None:
        """Show a line that says what could not be done below the output; "" removes it."""
        if text or self._error:
            self._error = text
            self._lay_out(to_end=True)

    def on_resize(self, event: events.Resize) -> None:
        """Wrap to the new width."""
        self._lay_out()

    def _lay_out(self, *, to_end: bool = False) -> None:
        follow = to_end or self.is_vertical_scroll_end or not self.rows
        width = max(20, self.scrollable_content_region.width)
        rows: list[Row] = []
        for pieces in (*_rows_of(self._state), *(((self._error, "error"),),) * bool(self._error)):
            rows += _wrapped(pieces, width)
        self.show_rows(rows)
        if follow:
            self.scroll_end(animate=False, immediate=True, force=True, x_axis=False)


def _rows_of(state: NodeState | None) -> Sequence[Row]:
    if state is None:
        return ()
    rows: list[Row] = [(("$ ", "quiet"), (state.command, "name"))]
    if state.dropped:
        rows.append(((f"({state.dropped} lines of a flood are not shown)", "quiet"),))
    rows += [_line(line) for line in state.lines]
    if state.phase is Phase.ENDED and (failure := _describe_failure(state)):
        rows.append(((failure, "error"),))
    return rows


def _describe_failure(state: NodeState) -> str:
    """Return how a command failed, or "" if it ended normally."""
    return f"[{state.note.removeprefix('ended by itself with ')}]" if failed_by_itself(state) else ""


def failed_by_itself(state: NodeState) -> bool:
    """Return whether a command failed by itself; after Ctrl+C, any exit code is fine."""
    return state.failed and not state.note.startswith("stopped")


def _line(line: OutputLine) -> Row:
    text = strip_ansi(line.text, tab=8)
    kind = next((kind for mark, kind in _LEVELS.items() if mark in text[:40]), "")
    return ((text, kind),)


def _wrapped(pieces: Row, width: int) -> list[Row]:
    rows: list[list[tuple[str, str]]] = [[]]
    room = width
    for text, kind in pieces:
        rest = text
        while rest and cell_len(rest) > room:
            head = chop_cells(rest, room)[0] if room > 1 else ""
            rows[-1].append((head, kind))
            rows.append([])
            rest, room = rest[len(head) :], width
        rows[-1].append((rest, kind))
        room -= cell_len(rest)
    return [tuple(row) for row in rows]
