"""What is wrong with a course, for its author."""

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
        """What is wrong, and how to fix it."""
        return f"{self.text}; {self.hint}" if self.hint else self.text

    def __str__(self) -> str:
        return f"{self.file}: {self.description}"
