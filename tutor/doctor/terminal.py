"""Examination of the terminal in which the app would run."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping

from tutor.doctor.finding import Finding

_NAME = "Terminal"
_MIN_COLUMNS, _MIN_ROWS = 80, 24


def capabilities(environ: Mapping[str, str] = os.environ) -> Finding:
    """Examine whether the terminal shows colour and UTF-8 and is large enough.

    A lack is only a warning, since reports are plain text.
    """
    if not sys.stdout.isatty():
        return Finding(_NAME, None, "The output is not a terminal: the app cannot be shown here, but reports can.")
    limitations = _find_limitations(environ)
    columns, rows = os.get_terminal_size(sys.stdout.fileno())
    if columns < _MIN_COLUMNS or rows < _MIN_ROWS:
        limitations.append(
            (f"it is {columns}x{rows}, smaller than {_MIN_COLUMNS}x{_MIN_ROWS}", "make the window larger")
        )
    if limitations:
        text = "This terminal is limited: " + "; ".join(what for what, _ in limitations) + "."
        return Finding(_NAME, None, text, "To see it well: " + "; ".join(hint for _, hint in limitations) + ".")
    return Finding(_NAME, True, f"{environ['TERM']}, {columns}x{rows}, colour, UTF-8")


def _find_limitations(environ: Mapping[str, str]) -> list[tuple[str, str]]:
    term = environ.get("TERM", "")
    found: list[tuple[str, str]] = []
    if term in ("", "dumb"):
        found.append(("TERM names no terminal that can be drawn on", "export TERM=xterm-256color"))
    elif "256" not in term and "COLORTERM" not in environ and not term.startswith(("xterm-", "tmux", "screen-256")):
        found.append(("it may show few colours", "export TERM=xterm-256color"))
    if (sys.stdout.encoding or "").lower().replace("-", "") != "utf8":
        found.append((f"its encoding is {sys.stdout.encoding}, not UTF-8", "export LANG=C.UTF-8"))
    return found
