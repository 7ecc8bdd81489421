"""The layout of the panels for a given terminal size."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Criteria(StrEnum):
    """Where the criteria go: behind a tab, below the text, or beside it."""

    FOLDED = "folded"
    STACKED = "stacked"
    BESIDE = "beside"


@dataclass(frozen=True, slots=True)
class Layout:
    """`lessons`: whether the lesson list has a column of its own; else it is a drawer over the text.

    `columns`: a page of the criteria has their diagnosis beside the list, for lack of height.
    """

    lessons: bool
    criteria: Criteria
    columns: bool = False


def layout_for(width: int, height: int) -> Layout:
    """Return the layout for a terminal of `width` columns and `height` rows."""
    if width >= 160:
        return Layout(True, Criteria.BESIDE)
    if width >= 90 and height >= 30:
        return Layout(width >= 100, Criteria.STACKED)
    return Layout(width >= 100, Criteria.FOLDED, columns=width >= 76 and height < 36)
