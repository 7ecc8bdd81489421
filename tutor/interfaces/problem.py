"""Why an interface package cannot be built, said of a place in its files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Problem:
    """One reason; `line` counts from 1, and is None where it is about the whole file (or folder)."""

    file: Path
    line: int | None
    reason: str

    def text(self, root: Path | None = None) -> str:
        """Return one sentence that begins with the place, relative to `root`: `src/p/msg/Reading.msg:3: ...`."""
        shown = self.file.relative_to(root) if root is not None and self.file.is_relative_to(root) else self.file
        return f"{shown}: {self.reason}" if self.line is None else f"{shown}:{self.line}: {self.reason}"

    def __str__(self) -> str:
        return self.text()
