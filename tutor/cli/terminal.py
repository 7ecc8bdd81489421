"""Terminal output: reports on stdout, everything else on stderr."""

from __future__ import annotations

import os
import shutil
import sys
import textwrap
from typing import TextIO

from tutor.errors import StorageError
from tutor.terminal_text import escape_controls, printable

_NON_TERMINAL_WIDTH = 100
_MAX_WIDTH = 120


def out(text: str) -> None:
    """Write to stdout, whatever its encoding, with all control sequences but colours escaped.

    A reader that has exited (`| head`) is not an error. Raises StorageError if the write fails otherwise.
    """
    if sys.stdout is None:
        return
    try:
        sys.stdout.write(_encodable(escape_controls(text, colors=wants_color(sys.stdout)), sys.stdout))
        sys.stdout.flush()
    except BrokenPipeError:
        _redirect_to_devnull(sys.stdout)
    except OSError as error:
        _redirect_to_devnull(sys.stdout)
        raise StorageError.of("write to stdout", error) from error


def say(text: str) -> None:
    """Print a message apart from the report, as one line on stderr. Never raises OSError."""
    if sys.stderr is None:
        return
    try:
        sys.stderr.write(_encodable(f"ros-tutor: {printable(text)}\n", sys.stderr))
        sys.stderr.flush()
    except OSError:
        _redirect_to_devnull(sys.stderr)


def is_terminal(stream: TextIO | None) -> bool:
    """Whether this stream is an open terminal."""
    try:
        return stream is not None and stream.isatty()
    except ValueError:  # it is closed
        return False


def wants_color(stream: TextIO | None) -> bool:
    """Whether to use colours on this stream. A non-empty NO_COLOR turns them off (https://no-color.org)."""
    return is_terminal(stream) and not os.environ.get("NO_COLOR") and os.environ.get("TERM", "dumb") != "dumb"


def can_animate(stream: TextIO | None) -> bool:
    """Whether lines on this stream can be redrawn."""
    return is_terminal(stream) and os.environ.get("TERM", "dumb") not in ("dumb", "unknown")


def width(stream: TextIO | None) -> int:
    """Return the line width for this stream, in columns: the terminal's, up to a limit; fixed for other streams."""
    return min(shutil.get_terminal_size().columns, _MAX_WIDTH) if is_terminal(stream) else _NON_TERMINAL_WIDTH


def wrap(text: str, columns: int) -> str:
    """Wrap long lines, except indented ones and those in a fenced block."""
    lines = []
    fenced = False
    for line in text.rstrip("\n").split("\n"):
        fence = line.lstrip().startswith("```")
        fenced ^= fence
        keep = fence or fenced or line.startswith("    ") or len(line) <= columns
        lines += [line] if keep else textwrap.wrap(line, columns, break_long_words=False, break_on_hyphens=False)
    return "\n".join(lines) + "\n"


def style(text: str, code: str, stream: TextIO | None) -> str:
    """Put `text` into an ANSI style ("1" bold, "2" dim, "32" green, ...) if the stream shows colours."""
    return f"\x1b[{code}m{printable(text)}\x1b[0m" if code and wants_color(stream) else text


def _encodable(text: str, stream: TextIO) -> str:
    encoding = getattr(stream, "encoding", None) or "utf-8"
    return text.encode(encoding, "replace").decode(encoding)


def _redirect_to_devnull(stream: TextIO) -> None:
    """Redirect a broken stream to /dev/null, so that the interpreter's flush at exit does not fail and complain."""
    try:
        target = stream.fileno()
    except (OSError, ValueError):
        return
    devnull = os.open(os.devnull, os.O_WRONLY)
    os.dup2(devnull, target)
    os.close(devnull)
