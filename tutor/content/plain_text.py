"""A lesson's Markdown as plain text."""

from __future__ import annotations

import re
from collections.abc import Iterator

_MARKUP = re.compile(
    r"""`+([^`]+)`+                                    # code
    | \*\*(.+?)\*\*                                    # strong
    | (?<![\w*])\*([^*\s](?:[^*]*[^*\s])?)\*(?![\w*])  # emphasis
    | !?\[([^\]]+)\]\([^)]*\)                         # a link
    | <(https?://[^>\s]+)>                             # an address
    | `+ | \*\*+                                       # a mark whose other half is on another line
    """,
    re.VERBOSE,
)
_BLOCK = re.compile(r"\s*(?:#{1,6}\s+|>\s?|[-*+]\s+)*")
_RULE = re.compile(r"[-|:\s]+")
"""A line between the rows of a table, or between paragraphs."""


def without_markup(text: str) -> str:
    """Return inline Markdown without its marks: code, emphasis, and links by their text."""
    return _MARKUP.sub(_inner_text, text)


def _inner_text(found: re.Match[str]) -> str:
    code, *texts = found.groups()
    return code if code is not None else without_markup(next((text for text in texts if text is not None), ""))


def plain_lines(markdown: str) -> Iterator[tuple[int, str]]:
    """Yield each line that has text as (number from 0, text without any markup). Lines of code are left as they are."""
    fenced = False
    for number, line in enumerate(markdown.splitlines()):
        text = line.strip()
        if text.startswith("```"):
            fenced = not fenced
        elif fenced and text:
            yield number, text
        elif text and not _RULE.fullmatch(text):
            plain = without_markup(_BLOCK.sub("", text, count=1))
            cells = [cell.strip() for cell in plain.strip("|").split("|")] if text.startswith("|") else [plain]
            yield number, " · ".join(cells)
