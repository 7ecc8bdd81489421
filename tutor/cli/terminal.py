"""The two streams: reports on stdout, everything else on stderr."""

from __future__ import annotations

import os
import shutil
import sys
import textwrap
from typing import TextIO

from tutor.errors import StorageError
from tutor.terminal_text import escape_controls, printable

_PLAIN_WIDTH = 100
_WIDEST = 120


def out(text: str) -> None:
    """Write to stdout, whatever its encoding, with no control sequence but colours.

    A reader that has gone away (`| head`) is not an error.
    """
    if sys.stdout is None:
        return
    try:
        sys.stdout.write(_encodable(escape_controls(text, colors=wants_color(sys.stdout)), sys.stdout))
        sys.stdout.flush()
    except BrokenPipeError:
        _to_nowhere(sys.stdout)
    except OSError as error:
        _to_nowhere(sys.stdout)
        raise StorageError.of("write to stdout", error) from error


def say(text: str) -> None:
    """Tell something beside the report: one line on stderr."""
    if sys.stderr is None:
        return
    try:
        sys.stderr.write(_encodable(f"ros-tutor: {printable(text)}\n", sys.stderr))
        sys.stderr.flush()
    except OSError:
        _to_nowhere(sys.stderr)


def is_terminal(stream: TextIO | None) -> bool:
    """Whether someone reads this stream as it comes."""
    try:
        return stream is not None and stream.isatty()
    except ValueError:  # it is closed
        return False


def wants_color(stream: TextIO | None) -> bool:
    """Whether to use colours on this stream. NO_COLOR, if not empty, says no (https://no-color.org)."""
    return is_terminal(stream) and not os.environ.get("NO_COLOR") and os.environ.get("TERM", "dumb") != "dumb"


def can_animate(stream: TextIO | None) -> bool:
    """Whether lines on this stream can be redrawn."""
    return is_terminal(stream) and os.environ.get("TERM", "dumb") not in ("dumb", "unknown")


def width(stream: TextIO | None) -> int:
    """How many columns a line should have: those of the terminal, within reason; a fixed number elsewhere."""
    return min(shutil.get_terminal_size().columns, _WIDEST) if is_terminal(stream) else _PLAIN_WIDTH


def wrap(text: str, columns: int) -> str:
    """Wrap long lines; short ones, indented ones and those in a fenced block stay as they are."""
    lines = []
    fenced = False
    for line in text.rstrip("\n").split("\n"):
        fence = line.lstrip().startswith("```")
        fenced ^= fence
        keep = fence or fenced or line.startswith("    ") or len(line) <= columns
        lines += [line] if keep else textwrap.wrap(line, columns, break_long_words=False, break_on_hyphens=False)
    return "\n".join(lines) + "\n"


def style(text: str, code: str, stream: TextIO | None) -> str:
    """Put `text` into an ANSI style ("1" bold, "2" dim, "32" green, ...) where the stream shows colours."""
    return f"\x1b[{code}m{printable(text)}\x1b[0m" if code and wants_color(stream) else text


def _encodable(text: str, stream: TextIO) -> str:
    encoding = getattr(stream, "encoding", None) or "utf-8"
    return text.encode(encoding, "replace").decode(encoding)


def _to_nowhere(stream: TextIO) -> None:
    """Nothing more can be written: keep the interpreter from trying again, and complaining, at its end."""
    try:
        target = stream.fileno()
    except (OSError, ValueError):
        return
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, target)
    os.close(nowhere)
