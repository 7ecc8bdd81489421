"""What can go wrong with a course: its files are broken, or someone asks for an exercise that it does not have."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches
from pathlib import Path


class ContentError(Exception):
    """A course file is broken: its author's mistake, never a learner's.

    `line` counts from 1; None means the whole file. `field` is the field's place in it, as in `criteria[2].hint`.
    """

    def __init__(self, file: Path, message: str, *, line: int | None = None, field: str = "") -> None:
        self.file = file
        self.line = line
        self.field = field
        self.message = message
        place = str(file) if line is None else f"{file}:{line}"
        super().__init__(f"{place}: {field}: {message}" if field else f"{place}: {message}")


class UnknownExercise(Exception):
    """Nobody knows this exercise. The message names the known ones, and the one that was probably meant."""

    def __init__(self, text: str, known: Sequence[str]) -> None:
        self.text = text
        self.known = tuple(known)
        near = get_close_matches(text.strip().lower().replace("_", "."), self.known, n=1, cutoff=0.5)
        self.nearest = near[0] if near else None
        guess = f" Did you mean {self.nearest}?" if self.nearest else ""
        super().__init__(f"There is no exercise {text!r}.{guess} The exercises are: {', '.join(self.known)}.")
