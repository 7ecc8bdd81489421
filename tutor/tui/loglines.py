"""Reads a node's output: what is a log message of which level, and which lines point into a source file. Pure."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tutor.judge.trace import Level, OutputLine
from tutor.terminal_text import strip_ansi

_ROS_LOG = re.compile(r"(?:\[[\w.-]+-\d+\] )?\[(DEBUG|INFO|WARN|ERROR|FATAL)\] \[(\d+\.\d+)\] \[([^\]]*)\]: ?(.*)")
_PLACE = re.compile(r'\s*File "([^"]+)", line (\d+)')
_ERROR = re.compile(r"[\w.]*(Error|Exception|Interrupt)\b")


@dataclass(frozen=True, slots=True)
class LogLine:
    """One line. `level` is None for what is not a log message; `said` is the text without what stands before it.

    `stamp` is a time in seconds since the epoch; `place` is the file and line, from 1, that a traceback names.
    """

    text: str
    message: str
    stderr: bool
    at: float
    level: Level | None = None
    stamp: float = 0.0
    name: str = ""
    place: tuple[Path, int] | None = None
    error: bool = False

    @property
    def weight(self) -> Level:
        """How loud it is: what is written to stderr and is not a log message counts as an error, a print as INFO."""
        return self.level or (Level.ERROR if self.stderr else Level.INFO)


def parse_line(line: OutputLine) -> LogLine:
    """What a line of output is."""
    text = strip_ansi(line.text)
    stderr = line.stream == "stderr"
    if found := _ROS_LOG.match(text):
        level, stamp, name, said = found.groups()
        return LogLine(text, said, stderr, line.at, Level[level], float(stamp), name)
    named = _PLACE.match(text)
    place = (Path(named[1]), int(named[2])) if named else None
    error = stderr and (text.startswith("Traceback ") or bool(_ERROR.match(text)))
    return LogLine(text, text, stderr, line.at, place=place, error=error)


def matching_lines(lines: Sequence[LogLine], level: Level, wanted: str, since: float) -> list[LogLine]:
    """The lines that are at least of `level`, hold the text `wanted` in any case, and came after `since`."""
    text = wanted.casefold()
    return [line for line in lines if line.at > since and line.weight >= level and text in line.text.casefold()]


def last_place(lines: Sequence[LogLine], own: Sequence[Path]) -> tuple[Path, int] | None:
    """Where the last traceback was last in one of the learner's own files."""
    return next((line.place for line in reversed(lines) if line.place is not None and line.place[0] in own), None)
