"""Predictions: what does this program print? The learner answers, then it runs, and what was seen is the judge.

A lesson's are in its folder, in predictions.yaml: for each its `id`, the `program`, a file of that folder, what it
`asks`, the `options`, and `because`, the explanation told afterwards. `shows` names items of the checklist.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from tutor.content.fields import Document, Fields

FILE = "predictions.yaml"


@dataclass(frozen=True, slots=True)
class Option:
    """One answer. It holds if the regular expression `seen` is found in a line that the program has written."""

    says: str
    seen: str


@dataclass(frozen=True, slots=True)
class Prediction:
    """One question about one program. `program` is its file; `shows` are ids of checklist items."""

    id: str
    program: Path
    asks: str
    options: tuple[Option, ...]
    because: str
    shows: tuple[str, ...] = ()

    def holding(self, lines: Iterable[str]) -> tuple[int, ...]:
        """Return the indices of the options that hold, given all lines that the program has written."""
        written = list(lines)
        patterns = [re.compile(option.seen) for option in self.options]
        return tuple(index for index, pattern in enumerate(patterns) if any(map(pattern.search, written)))


def read_predictions(folder: Path) -> tuple[Prediction, ...]:
    """Read the predictions of the lesson in this folder; empty if it has none. Raises ContentError."""
    file = folder / FILE
    if not file.exists():
        return ()
    fields = Document.of(file).read()
    predictions = tuple(_read_prediction(item, folder) for item in fields.mappings("predictions"))
    fields.done()
    return predictions


def _read_prediction(fields: Fields, folder: Path) -> Prediction:
    program = fields.text("program")
    if Path(program).is_absolute() or ".." in Path(program).parts:
        raise fields.error("program", f"expected a file of the lesson's folder, found {program!r}")
    prediction = Prediction(
        id=fields.text("id"),
        program=folder / program,
        asks=fields.text("asks"),
        options=tuple(_read_option(item) for item in fields.mappings("options")),
        because=fields.text("because"),
        shows=fields.texts("shows", optional=True),
    )
    fields.done()
    return prediction


def _read_option(fields: Fields) -> Option:
    option = Option(says=fields.text("says"), seen=fields.text("seen"))
    try:
        re.compile(option.seen)
    except re.error as error:
        raise fields.error("seen", f"{option.seen!r} is no regular expression: {error}") from error
    fields.done()
    return option
