"""What is wrong with a course, for its author."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing to mend in a course. `file` is the file, or the folder, to mend it in; `mend` says how."""

    file: Path
    text: str
    mend: str = ""

    @property
    def said(self) -> str:
        """What is wrong, and how to mend it."""
        return f"{self.text}; {self.mend}" if self.mend else self.text

    def __str__(self) -> str:
        return f"{self.file}: {self.said}"
