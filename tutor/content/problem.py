"""A problem in a course, reported to its author."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing to fix in a course. `file` is the file, or the folder, to fix it in; `hint` says how."""

    file: Path
    text: str
    hint: str = ""

    @property
    def description(self) -> str:
        """The problem and how to fix it, in one line."""
        return f"{self.text}; {self.hint}" if self.hint else self.text

    def __str__(self) -> str:
        return f"{self.file}: {self.description}"
