"""Makes foreign text safe to show: text from a node, a file or a file name must never control the terminal."""

from __future__ import annotations

import io
import re
from typing import TextIO

# Control characters and direction overrides.
_UNSAFE = "\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ufffe\uffff"
_CONTROL = re.compile(f"[{_UNSAFE}]")
_NOT_COLOR = re.compile(rf"(?!\x1b\[[\d;]*m)[{_UNSAFE}]")
_SEQUENCE = re.compile(r"\x1b(?:\[[0-?]*[ -/]*[@-~]|\][^\x07\x1b]*(?:\x07|\x1b\\)?|[@-Z\\^_])")
_SURROGATE = re.compile("[\ud800-\udfff]")
_REPLACEMENT = "\N{REPLACEMENT CHARACTER}"


def escape_controls(text: str, *, colors: bool = False) -> str:
    """Escape control characters and text direction overrides; with `colors`, keep color sequences.

    Newlines and tabs are kept.
    """
    unsafe = _NOT_COLOR if colors else _CONTROL
    return unsafe.sub(lambda match: match[0].encode("unicode_escape").decode(), text)


def printable(text: str) -> str:
    """Like `escape_controls`, but with tabs as spaces, and a replacement character for invalid Unicode."""
    return escape_controls(_SURROGATE.sub(_REPLACEMENT, text.replace("\r\n", "\n").expandtabs(4)))


def strip_ansi(text: str, tab: int = 4) -> str:
    """Strip colors, titles and cursor movements from one line of a program's output, with tabs as spaces."""
    if text.isprintable():
        return text
    return _replace_controls(_SEQUENCE.sub("", text).rstrip("\r"), _REPLACEMENT).expandtabs(tab)


def strip_controls(text: str) -> str:
    """Remove everything that controls a terminal; the result takes up as many screen cells as the original."""
    return text if text.isprintable() else _replace_controls(text.replace("\t", "").replace("\n", ""), "")


def guard_terminal(stream: TextIO) -> TextIO:
    """Return the stream, wrapped if it is a terminal so that only text and colors get through."""
    return _SafeTerminal(stream) if isinstance(stream, io.TextIOWrapper) and stream.isatty() else stream


class _SafeTerminal(io.TextIOWrapper):
    def __init__(self, stream: io.TextIOWrapper) -> None:
        super().__init__(stream.buffer, stream.encoding, stream.errors, line_buffering=True)

    def write(self, text: str) -> int:
        super().write(escape_controls(text, colors=True))
        return len(text)


def _replace_controls(text: str, instead: str) -> str:
    return _SURROGATE.sub(_REPLACEMENT, _CONTROL.sub(instead, text))
