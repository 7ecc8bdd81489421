"""The history of parameter sets and service calls with their outcomes, newest first."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from typing import ClassVar

from rich.cells import cell_len, chop_cells
from textual import events

from tutor.live.updates import CallOutcome, SetOutcome
from tutor.ros_model.values import format_value
from tutor.tui.live.formatting import period
from tutor.tui.widgets.line_view import LineView, Row

_MAX_VALUE_CHARS = 60


class HistoryView(LineView):
    """Rows of outcomes, each with a mark, a word and a time; colour is never the only sign."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {f"line--{kind}" for kind in ("quiet", "good", "bad", "busy", "name")}
    DEFAULT_CSS = """
    HistoryView {
        & > .line--quiet { color: $quiet; }
        & > .line--good { color: $good; }
        & > .line--bad { color: $bad; }
        & > .line--busy { color: $busy; }
        & > .line--name { color: $code-type; }
    }
    """

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self._unwrapped: Sequence[Row] = ()

    def show_outcomes(self, rows: Sequence[Row]) -> None:
        """Show these rows, wrapped to the width; the scroll position stays."""
        self._unwrapped = rows
        width = max(24, self.scrollable_content_region.width)
        self.show_rows([wrapped for row in rows for wrapped in _wrapped(row, width)])

    def on_resize(self, event: events.Resize) -> None:
        """Wrap to the new width."""
        self.show_outcomes(self._unwrapped)


def _wrapped(row: Row, width: int) -> Iterable[Row]:
    """Wrap a row: its last piece continues below, indented by the width of the row's first piece."""
    if not row or sum(cell_len(text) for text, _ in row) <= width:
        return [row]
    *head, (last, kind) = row
    room = width - sum(cell_len(text) for text, _ in head)
    indent = cell_len(row[0][0]) if head else len(last) - len(last.lstrip())
    rest = last
    rows: list[Row] = []
    if room >= min(12, cell_len(last)):
        first, rest = _cut(last, room)
        rows.append((*head, (first, kind)))
    else:
        rows.append(tuple(head))
    while rest := rest.strip():
        first, rest = _cut(rest, width - indent)
        rows.append(((" " * indent, ""), (first, kind)))
    return rows


def _cut(text: str, room: int) -> tuple[str, str]:
    """Split a text into as many words as fit (at least one cell of one) and the rest."""
    if cell_len(text) <= room:
        return text, ""
    head = chop_cells(text, max(1, room))[0]
    if " " in head.strip():
        head = head[: head.rindex(" ") + 1]
    return head, text[len(head) :]


def set_rows(outcome: SetOutcome) -> Iterable[Row]:
    """Return the rows of one parameter set."""
    assignment = f"{outcome.node} {outcome.name} = {_value(outcome.value)}"
    if not outcome.answered:
        mark, word, kind = "!", f"no answer within {period(outcome.took_s)}: does the node spin?", "bad"
    elif outcome.accepted:
        mark, word, kind = "✓", f"accepted, {period(outcome.took_s)}", "good"
    else:
        mark, word, kind = "✗", "rejected", "bad"
    yield ((f" {mark} ", kind), (_clock(outcome.at), "quiet"), (f"  {assignment}  ", ""), (word, kind))
    if outcome.answered and (outcome.reason or not outcome.accepted):
        yield ((" " * 13, ""), (outcome.reason or "the node gave no reason", "quiet" if outcome.accepted else "bad"))


def call_rows(outcome: CallOutcome) -> Iterable[Row]:
    """Return the rows of one service call and its answer."""
    arguments = ", ".join(f"{path}={_value(value)}" for path, value in outcome.request.items())
    head: Row = ((_clock(outcome.at), "quiet"), (f"  {outcome.service} ", ""), (arguments, "quiet"))
    if outcome.text is not None:
        yield ((" ✓ ", "good"), *head)
        yield ((f"   answered in {period(outcome.took_s)}", "good"),)
        for line in outcome.text.splitlines():
            yield ((f"   {line}", ""),)
    else:
        mark, kind = ("■", "quiet") if outcome.problem == "cancelled" else ("✗", "bad")
        yield ((f" {mark} ", kind), *head)
        yield ((f"   {outcome.problem}", kind), (f" after {period(outcome.took_s)}", "quiet"))


def waiting_row(service: str, since: float, now: float) -> Row:
    """Return the row of a call that is still waiting for its answer."""
    return ((" ◐ ", "busy"), (_clock(since), "quiet"), (f"  {service}  ", ""), (f"waiting {now - since:.1f} s", "busy"))


def _clock(at: float) -> str:
    return time.strftime("%H:%M:%S", time.localtime(at))


def _value(value: object) -> str:
    text = format_value(value)
    if isinstance(value, str) and (not text or text != text.strip()):
        text = f"'{text}'"
    return text if len(text) <= _MAX_VALUE_CHARS else f"{text[:_MAX_VALUE_CHARS]}..."
