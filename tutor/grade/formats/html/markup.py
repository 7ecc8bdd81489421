"""HTML by construction: whatever is not HTML already is text, and is escaped."""

from __future__ import annotations

import base64
from collections.abc import Iterable
from functools import cache
from hashlib import sha256
from html import escape
from pathlib import Path

from tutor.terminal_text import printable

_VOID = frozenset({"br", "col", "input", "meta"})
_LINES = (
    "article colgroup details div dl footer form h1 h2 h3 header li main nav ol option p section table tbody template"
)
_ON_LINES = frozenset([*_LINES.split(), "tfoot", "thead", "tr", "ul"])
"""Elements that end with a line."""


class Html(str):
    """Text that is HTML. Any other text is escaped before it becomes part of a page."""

    __slots__ = ()


def text(value: str) -> Html:
    """Return text as HTML that shows it as it is; of control characters, it shows their escapes."""
    return value if isinstance(value, Html) else Html(escape(printable(value)))


def element(name: str, /, *children: str, **attributes: str | int | bool) -> Html:
    """Return an element. Children that are no `Html` are escaped, and so is every attribute.

    In the names of attributes, "class_" stands for "class", and an underscore for a hyphen. False leaves one out.
    """
    opening = "".join(
        f" {key.rstrip('_').replace('_', '-')}" + ("" if value is True else f'="{text(str(value))}"')
        for key, value in attributes.items()
        if value is not False
    )
    if name in _VOID:
        return Html(f"<{name}{opening}>")
    end = "\n" if name in _ON_LINES else ""
    return Html(f"<{name}{opening}>{''.join(map(text, children))}</{name}>{end}")


def joined(parts: Iterable[str], between: str = "") -> Html:
    """Return the parts one after the other, each escaped unless it is HTML."""
    return Html(text(between).join(map(text, parts)))


def inline(value: str) -> Html:
    """Return text in which what stands between backticks is code."""
    parts = value.split("`")
    if len(parts) % 2 == 0:  # one of them has no partner
        return text(value)
    return joined(element("code", part) if place % 2 else part for place, part in enumerate(parts))


def document(title: str, body: Iterable[str], *, styles: Iterable[str], script: str = "") -> str:
    """Return a whole page. `styles` and `script` are files of this package, which become part of it.

    The page can load nothing and run nothing but that script: its Content-Security-Policy says so.
    """
    style = "".join(map(asset, styles))
    code = asset(script) if script else ""
    policy = ["default-src 'none'", f"style-src {_digest(style)}", "base-uri 'none'", "form-action 'none'"]
    policy += [f"script-src {_digest(code)}"] if code else []
    head = (
        element("meta", charset="utf-8"),
        # Digests have no character that needs escaping, and quotes stay readable.
        Html(f'<meta http-equiv="Content-Security-Policy" content="{"; ".join(policy)}">'),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("meta", name="color-scheme", content="light dark"),
        element("meta", name="referrer", content="no-referrer"),
        element("title", title),
        element("style", Html(style)),
    )
    parts = [*body, *([element("script", Html(code))] if code else [])]
    return f'<!DOCTYPE html>\n<html lang="en">\n<head>\n{joined(head, Html(chr(10)))}\n</head>\n' + (
        f"<body>\n{joined(parts)}</body>\n</html>\n"
    )


@cache
def asset(name: str) -> str:
    """Return the text of a file of this package."""
    return Path(__file__).with_name(name).read_text(encoding="utf-8")


def _digest(source: str) -> str:
    return f"'sha256-{base64.b64encode(sha256(source.encode()).digest()).decode()}'"
