"""Python source with line numbers, to read."""

from __future__ import annotations

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

from tutor.tui.widgets.line_view import LineView, Row

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
        for kind in ("gutter", "keyword", "string", "number", "comment", "name", "type", "gone", "come", "same")
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
        & > .line--gone { color: $bad; }
        & > .line--come { color: $good; }
        & > .line--same { color: $quiet; }
    }
    """

    def show_source(self, source: str) -> None:
        """Show this source text."""
        rows = highlighted(source)
        width = max(3, len(str(len(rows))))
        self.show_rows(rows, [(f" {number:>{width}}  ", "gutter") for number in range(1, len(rows) + 1)])


def highlighted(source: str) -> list[Row]:
    """Source text as rows of coloured pieces, tabs expanded. Whatever the text is, this gives its lines."""
    rows: list[list[tuple[str, str]]] = [[]]
    for token, text in PythonLexer(stripnl=False, ensurenl=False).get_tokens(source.expandtabs(4)):
        first, *more = text.split("\n")
        rows[-1].append((_printable(first), _kind(token)))
        rows += [[(_printable(part), _kind(token))] for part in more]
    if len(rows) > 1 and not any(text for text, _ in rows[-1]):
        rows.pop()
    return [tuple(piece for piece in row if piece[0]) for row in rows]


def _kind(token: Any) -> str:
    """The kind of a token type, or of the nearest one that it is a special case of."""
    while token is not None and token not in _KINDS:
        token = token.parent
    return _KINDS[token] if token is not None else ""


def _printable(text: str) -> str:
    """Control characters would move the cursor of the terminal."""
    return "".join(c if c.isprintable() else "·" for c in text)
