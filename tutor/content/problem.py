"""A problem in a course, reported to its author."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tutor.errors import ContentError


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing to fix in a course. `file` is the file, or the folder, to fix it in; `hint` says how.

    `line` counts from 1; None means the whole file.
    """

    file: Path
    text: str
    hint: str = ""
    line: int | None = None

    @property
    def description(self) -> str:
        """The problem and how to fix it, in one line."""
        return f"{self.text}; {self.hint}" if self.hint else self.text

    def __str__(self) -> str:
        return f"{self.file}{self.line_suffix}: {self.description}"

    @property
    def line_suffix(self) -> str:
        """What follows the file's name where the line is known, such as ":12"."""
        return "" if self.line is None else f":{self.line}"

    @classmethod
    def of(cls, error: ContentError) -> Problem:
        """The problem because of which a file of the course cannot be read."""
        return cls(error.file, f"{error.field}: {error.message}" if error.field else error.message, line=error.line)
