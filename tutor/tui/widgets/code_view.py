"""A read-only view of Python source, highlighted and with line numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, ClassVar

from pygments.lexers.python import PythonLexer  # type: ignore[import-untyped]
from pygments.token import (  # type: ignore[import-untyped]
    Comment,
    Keyword,
    Name,
    Number,
    Operator,
    String,
)
from textual import events

from tutor.tui.widgets.line_view import LineView, Piece, Row

_KINDS = {
    Comment: "comment",
    Keyword: "keyword",
    Operator.Word: "keyword",
    String: "string",
    Number: "number",
    Name.Function: "name",
    Name.Decorator: "name",
    Name.Class: "type",
    Name.Builtin: "type",
    Name.Exception: "type",
}


class CodeView(LineView):
    """One file, read-only."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        f"line--{kind}"
        for kind in ("gutter", "keyword", "string", "number", "comment", "name", "type", "removed", "added", "same")
    }
    DEFAULT_CSS = """
    CodeView {
        & > .line--gutter { color: $quiet; }
        & > .line--keyword { color: $code-keyword; }
        & > .line--string { color: $code-string; }
        & > .line--number { color: $code-number; }
        & > .line--comment { color: $code-comment; text-style: italic; }
        & > .line--name { color: $code-name; }
        & > .line--type { color: $code-type; }
        & > .line--removed { color: $bad; }
        & > .line--added { color: $good; }
        & > .line--same { color: $quiet; }
    }
    """

    _make_rows: Callable[[int], tuple[Sequence[Row], Sequence[Piece]]] | None = None

    def show_made(self, make: Callable[[int], tuple[Sequence[Row], Sequence[Piece]]]) -> None:
        """Show the rows and margins that `make` returns for the width of the view, now and when that changes."""
        self._make_rows = make
        self.show_rows(*make(self.size.width))

    def on_resize(self, event: events.Resize) -> None:
        """Make the rows for the new width."""
        if self._make_rows is not None:
            self.show_rows(*self._make_rows(event.size.width))

    def show_source(self, source: str) -> None:
        """Show this source text."""
        self._make_rows = None
        rows = highlight(source)
        width = max(3, len(str(len(rows))))
        self.show_rows(rows, [(f" {number:>{width}}  ", "gutter") for number in range(1, len(rows) + 1)])


def highlight(source: str) -> list[Row]:
    """Return source text as rows of coloured pieces, tabs expanded. Invalid Python keeps all its lines, too."""
    rows: list[list[tuple[str, str]]] = [[]]
    for token, text in PythonLexer(stripnl=False, ensurenl=False).get_tokens(source.expandtabs(4)):
        first, *more = text.split("\n")
        rows[-1].append((_printable(first), _kind(token)))
        rows += [[(_printable(part), _kind(token))] for part in more]
    if len(rows) > 1 and not any(text for text, _ in rows[-1]):
        rows.pop()
    return [tuple(piece for piece in row if piece[0]) for row in rows]


def _kind(token: Any) -> str:
    """Return the kind of a token type, or of its nearest ancestor that has one."""
    while token is not None and token not in _KINDS:
        token = token.parent
    return _KINDS[token] if token is not None else ""


def _printable(text: str) -> str:
    """Replace unprintable characters: control characters would move the terminal's cursor."""
    return "".join(c if c.isprintable() else "·" for c in text)
