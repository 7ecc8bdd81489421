"""Where the panels go at a terminal's size."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Criteria(StrEnum):
    """Where the criteria are: behind a tab, below the text, or beside it."""

    FOLDED = "folded"
    STACKED = "stacked"
    BESIDE = "beside"


@dataclass(frozen=True, slots=True)
class Layout:
    """`lessons`: whether the list of lessons has a place of its own, or is a drawer over the text."""

    lessons: bool
    criteria: Criteria


def layout_for(width: int, height: int) -> Layout:
    """The layout for this many columns and rows."""
    if width >= 160:
        return Layout(True, Criteria.BESIDE)
    return Layout(width >= 100, Criteria.STACKED if width >= 90 and height >= 30 else Criteria.FOLDED)
