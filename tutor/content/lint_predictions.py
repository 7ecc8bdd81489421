"""Lints the predictions of a lesson: that their options differ, their programs can be shown, and their items exist."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator

from tutor.content.model import Lesson
from tutor.content.places import find_line
from tutor.content.predictions import FILE, Prediction
from tutor.content.problem import Problem

OPTIONS = range(2, 5)
"""How many options a prediction may have: as many as can be weighed at a glance."""

WIDTH = 71
"""The longest line of a program that the app shows without scrolling on an 80-column terminal."""

_ID = re.compile(r"[a-z][a-z0-9-]*")


def find_bad_predictions(lesson: Lesson, items: Collection[str]) -> Iterator[Problem]:
    """Find what is wrong in a lesson's predictions; `items` are the ids of the checklist."""
    file = lesson.folder / FILE
    for prediction_id in _duplicates(prediction.id for prediction in lesson.predictions):
        yield Problem(
            file, f"the prediction {prediction_id} appears twice", "give each its id", find_line(file, prediction_id)
        )
    for prediction in lesson.predictions:
        line = find_line(file, rf"\bid: *{re.escape(prediction.id)}\s*$")
        for text in _lint(prediction, items):
            yield Problem(file, f"the prediction {prediction.id}: {text}", line=line)
        yield from _lint_program(prediction)


def _lint(prediction: Prediction, items: Collection[str]) -> Iterator[str]:
    if not _ID.fullmatch(prediction.id):
        yield "its id is not in kebab-case"
    if len(prediction.options) not in OPTIONS:
        yield f"it has {len(prediction.options)} options, not {OPTIONS[0]} to {OPTIONS[-1]}"
    for says in _duplicates(option.says for option in prediction.options):
        yield f"the option {says!r} appears twice"
    for seen in _duplicates(option.seen for option in prediction.options):
        yield f"two options hold when {seen!r} is seen"
    if not prediction.asks.endswith("?"):
        yield "what it asks does not end with a question mark"
    for item in prediction.shows:
        if item not in items:
            yield f"the checklist has no item {item!r}"
    for item in _duplicates(prediction.shows):
        yield f"the checklist item {item} is named twice"


def _lint_program(prediction: Prediction) -> Iterator[Problem]:
    try:
        lines = prediction.program.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError):
        return  # the files of the folder are examined as such
    for number, line in enumerate(lines, 1):
        if len(line) > WIDTH:
            yield Problem(prediction.program, f"{line.strip()!r} is wider than {WIDTH} characters", line=number)


def _duplicates(values: Iterable[str]) -> list[str]:
    return [value for value, count in Counter(values).items() if count > 1]
