"""Parses a node's output: log messages with their levels, and the source lines that tracebacks point to. Pure."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tutor.judge.trace import Level, OutputLine
from tutor.terminal_text import strip_ansi

_ROS_LOG = re.compile(r"(?:\[[\w.-]+-\d+\] )?\[(DEBUG|INFO|WARN|ERROR|FATAL)\] \[(\d+\.\d+)\] \[([^\]]*)\]: ?(.*)")
_LOCATION = re.compile(r'\s*File "([^"]+)", line (\d+)')
_ERROR = re.compile(r"[\w.]*(Error|Exception|Interrupt)\b")


@dataclass(frozen=True, slots=True)
class LogLine:
    """One line of output. `level` is None unless it is a log message; `message` is the text without the log prefix.

    `at` is when it was received and `stamp` the time in its log prefix, in seconds since the epoch; `location` is the
    file and line (from 1) that a traceback names. `error`: it begins or ends a traceback.
    """

    text: str
    message: str
    stderr: bool
    at: float
    level: Level | None = None
    stamp: float = 0.0
    name: str = ""
    location: tuple[Path, int] | None = None
    error: bool = False

    @property
    def severity(self) -> Level:
        """The severity to filter by: without a log level, stderr counts as ERROR and stdout as INFO."""
        return self.level or (Level.ERROR if self.stderr else Level.INFO)


def parse_line(line: OutputLine) -> LogLine:
    """Parse one line of output."""
    text = strip_ansi(line.text)
    stderr = line.stream == "stderr"
    if found := _ROS_LOG.match(text):
        level, stamp, name, message = found.groups()
        return LogLine(text, message, stderr, line.at, Level[level], float(stamp), name)
    named = _LOCATION.match(text)
    location = (Path(named[1]), int(named[2])) if named else None
    error = stderr and (text.startswith("Traceback ") or bool(_ERROR.match(text)))
    return LogLine(text, text, stderr, line.at, location=location, error=error)


def matching_lines(lines: Sequence[LogLine], level: Level, wanted: str, since: float) -> list[LogLine]:
    """Return the lines of at least `level` that contain `wanted` (ignoring case) and came after `since`."""
    text = wanted.casefold()
    return [line for line in lines if line.at > since and line.severity >= level and text in line.text.casefold()]


def last_own_location(lines: Sequence[LogLine], own: Sequence[Path]) -> tuple[Path, int] | None:
    """Return the last location in one of the files `own` that a traceback names."""
    return next(
        (line.location for line in reversed(lines) if line.location is not None and line.location[0] in own), None
    )
