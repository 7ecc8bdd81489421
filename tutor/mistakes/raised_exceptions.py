"""Exceptions of a learner's program, as a traceback in its output shows them."""

from __future__ import annotations

import ast
from dataclasses import dataclass

from tutor.judge.tracebacks import Frame, Traceback
from tutor.source import Program

MAX_CHARACTERS = 110
"""Length to which an exception's message is cut in a sentence."""


@dataclass(frozen=True, slots=True)
class RaisedException:
    """A traceback, the learner's own line in it, and the file with that line; `after` says what it led to."""

    traceback: Traceback
    folder: str
    line: Frame | None
    file: str = ""
    source: str = ""
    after: str = ""

    @property
    def name(self) -> str:
        """The exception's name, without its module."""
        return self.traceback.type.rpartition(".")[2]

    @property
    def raised(self) -> str:
        """The exception in one line, without what helps nobody, and what it led to."""
        message = self.traceback.plain_message
        if len(message) > MAX_CHARACTERS:
            message = f"{message[: MAX_CHARACTERS - 3]}..."
        return f"{self.name}: {message}{self.after}" if message else f"{self.name}{self.after}"

    def is_raised_in(self, path: str) -> bool:
        """Whether the innermost frame is in this file or folder of a library, such as "rclpy/"."""
        return bool(self.traceback.frames) and path in self.traceback.frames[-1].path


def exceptions_of(last: Traceback | None, program: Program, folder: str) -> tuple[RaisedException, ...]:
    """The exceptions of a traceback's chain, the likeliest root first.

    The origin comes first; if the program handles it, and a call in its handler fails, the last exception does.
    """
    if last is None:
        return ()
    chain = [last]
    while (before := chain[-1].follows) is not None:
        chain.append(before)
    if not _fails_in_handler(last, program, folder):
        chain.reverse()
    return tuple(_read(raised, last, program, folder) for raised in chain)


def _read(raised: Traceback, last: Traceback, program: Program, folder: str) -> RaisedException:
    own = raised.own(folder) or last.own(folder)
    file = own.name if own and own.name in program.sources else program.started
    after = "" if raised is last else f"; then {last.type.rpartition('.')[2]}"
    return RaisedException(raised, folder, own, file, program.sources.get(file, ""), after)


def _fails_in_handler(raised: Traceback, program: Program, folder: str) -> bool:
    """Whether the exception comes from a statement of the learner's exception handler other than a `raise`."""
    own = raised.own(folder)
    if raised.follows is None or own is None:
        return False
    file = program.named(own.name)
    statement = file.statement_at(own.line)
    return (
        statement is not None
        and not isinstance(statement, ast.Raise)
        and any(isinstance(around, ast.ExceptHandler) for around in file.ancestors(statement))
    )
