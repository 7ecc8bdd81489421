"""Foreign text made safe to show: what comes from a node, a file or a name never steers a terminal."""

from __future__ import annotations

import io
import re
from typing import TextIO

_UNSAFE = "\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ufffe\uffff"  # controls, and what turns the direction
_CONTROL = re.compile(f"[{_UNSAFE}]")
_NOT_COLOR = re.compile(rf"(?!\x1b\[[\d;]*m)[{_UNSAFE}]")
_SEQUENCE = re.compile(r"\x1b(?:\[[0-?]*[ -/]*[@-~]|\][^\x07\x1b]*(?:\x07|\x1b\\)?|[@-Z\\^_])")
_SURROGATE = re.compile("[\ud800-\udfff]")
_REPLACEMENT = "\N{REPLACEMENT CHARACTER}"


def escape_controls(text: str, *, colors: bool = False) -> str:
    """Show control characters, and those that turn the direction of text, as escapes; with `colors`, all but colours.

    Line ends and tabs stay.
    """
    unsafe = _NOT_COLOR if colors else _CONTROL
    return unsafe.sub(lambda found: found[0].encode("unicode_escape").decode(), text)


def printable(text: str) -> str:
    """As `escape_controls`, with spaces for tabs; what is not valid Unicode becomes a replacement character."""
    return escape_controls(_SURROGATE.sub(_REPLACEMENT, text.replace("\r\n", "\n").expandtabs(4)))


def strip_ansi(text: str, tab: int = 4) -> str:
    """One line of a program's output without its colours, titles and moves of the cursor; tabs as spaces."""
    if text.isprintable():
        return text
    return _replace_controls(_SEQUENCE.sub("", text).rstrip("\r"), _REPLACEMENT).expandtabs(tab)


def strip_controls(text: str) -> str:
    """Text that takes as many cells of a screen as the one given, with nothing in it that a terminal obeys."""
    return text if text.isprintable() else _replace_controls(text.replace("\t", "").replace("\n", ""), "")


def guard_terminal(stream: TextIO) -> TextIO:
    """The stream; where it is a terminal, one in front of it to which nothing but text and colours comes through."""
    return _ToTerminal(stream) if isinstance(stream, io.TextIOWrapper) and stream.isatty() else stream


class _ToTerminal(io.TextIOWrapper):
    def __init__(self, stream: io.TextIOWrapper) -> None:
        super().__init__(stream.buffer, stream.encoding, stream.errors, line_buffering=True)

    def write(self, text: str) -> int:
        super().write(escape_controls(text, colors=True))
        return len(text)


def _replace_controls(text: str, instead: str) -> str:
    return _SURROGATE.sub(_REPLACEMENT, _CONTROL.sub(instead, text))
