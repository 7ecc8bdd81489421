"""Examination of the terminal that the app will be shown in."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping

from tutor.doctor.finding import Finding

_NAME = "Terminal"
_COLUMNS, _ROWS = 80, 24


def capabilities(environ: Mapping[str, str] = os.environ) -> Finding:
    """Whether the terminal shows colour and UTF-8 and is large enough. Never a failure: reports are plain text."""
    if not sys.stdout.isatty():
        return Finding(_NAME, None, "The output is not a terminal: the app cannot be shown here, reports can.")
    wanting = _wanting(environ)
    columns, rows = os.get_terminal_size(sys.stdout.fileno())
    if columns < _COLUMNS or rows < _ROWS:
        wanting.append((f"it is {columns}x{rows}, smaller than {_COLUMNS}x{_ROWS}", "make the window larger"))
    if wanting:
        text = "This terminal is limited: " + "; ".join(what for what, _ in wanting) + "."
        return Finding(_NAME, None, text, "To see it well: " + "; ".join(hint for _, hint in wanting) + ".")
    return Finding(_NAME, True, f"{environ['TERM']}, {columns}x{rows}, colour, UTF-8")


def _wanting(environ: Mapping[str, str]) -> list[tuple[str, str]]:
    term = environ.get("TERM", "")
    found: list[tuple[str, str]] = []
    if term in ("", "dumb"):
        found.append(("TERM names no terminal that can be drawn on", "export TERM=xterm-256color"))
    elif "256" not in term and "COLORTERM" not in environ and not term.startswith(("xterm-", "tmux", "screen-256")):
        found.append(("it may show few colours", "export TERM=xterm-256color"))
    if (sys.stdout.encoding or "").lower().replace("-", "") != "utf8":
        found.append((f"its encoding is {sys.stdout.encoding}, not UTF-8", "export LANG=C.UTF-8"))
    return found
