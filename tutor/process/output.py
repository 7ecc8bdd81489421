"""Bounded storage for the output of a process: the first and last lines of each stream."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

from tutor.judge.trace import OutputLine

FIRST_LINES = 200
LAST_LINES = 800
LINE_CHARACTERS = 2000
# UTF-8 needs up to four bytes for a character.
_LINE_BYTES = 4 * LINE_CHARACTERS

_Raw = tuple[int, bytes, float]


@dataclass(slots=True)
class _Stream:
    first: list[_Raw] = field(default_factory=list)
    last: deque[_Raw] = field(default_factory=lambda: deque(maxlen=LAST_LINES))
    complete: int = 0
    partial: bytes = b""
    partial_at: float = 0.0
    partial_order: int = 0


class Output:
    """The output of one process.

    Each stream keeps its first `FIRST_LINES` and last `LAST_LINES` lines, so that a flood on one never drives out a
    traceback on the other. A line is cut at `LINE_CHARACTERS`. Lines are stored as bytes and decoded only when read, so
    a flood costs no more than finding a few line ends.
    """

    def __init__(self) -> None:
        self._streams: dict[str, _Stream] = {"stdout": _Stream(), "stderr": _Stream()}
        self._order = 0
        self._lines: tuple[OutputLine, ...] | None = ()

    def feed(self, stream: str, data: bytes, at: float) -> None:
        """Add data read from `stream` ("stdout" or "stderr") at the time `at` (seconds since the epoch)."""
        if not data:
            return
        s = self._streams[stream]
        self._order += 1
        self._lines = None
        start = 0
        while len(s.first) < FIRST_LINES:
            end = data.find(b"\n", start)
            if end < 0:
                break
            s.first.append(self._finish_line(s, data[start:end], at))
            start = end + 1
        *lines, rest = data[start:].rsplit(b"\n", LAST_LINES + 1)
        if len(lines) > LAST_LINES:  # the first piece holds all earlier lines, which are only counted
            s.complete += lines.pop(0).count(b"\n") + 1
            s.partial = b""
        for line in lines:
            s.last.append(self._finish_line(s, line, at))
        if rest:
            if not s.partial:
                s.partial_at, s.partial_order = at, self._order
            s.partial = (s.partial + rest[:_LINE_BYTES])[:_LINE_BYTES]

    def _finish_line(self, s: _Stream, line: bytes, at: float) -> _Raw:
        line = (s.partial + line[:_LINE_BYTES])[:_LINE_BYTES]
        if len(line) > LINE_CHARACTERS:
            line = _decode(line).encode()
        s.partial = b""
        s.complete += 1
        return (self._order, line, at)

    @property
    def lines(self) -> tuple[OutputLine, ...]:
        """The stored lines in the order they were read, including an unfinished last line."""
        if self._lines is None:
            found = [(raw, name) for name, s in self._streams.items() for raw in _kept(s)]
            found.sort(key=lambda item: item[0][0])
            self._lines = tuple(OutputLine(name, _decode(line), at) for (_, line, at), name in found)
        return self._lines

    @property
    def dropped_lines(self) -> int:
        """The number of lines dropped from the middle."""
        return sum(s.complete - len(s.first) - len(s.last) for s in self._streams.values())


def _kept(s: _Stream) -> list[_Raw]:
    partial = [(s.partial_order, s.partial, s.partial_at)] if s.partial else []
    return [*s.first, *s.last, *partial]


def _decode(line: bytes) -> str:
    return line.removesuffix(b"\r").decode("utf-8", "replace")[:LINE_CHARACTERS]
