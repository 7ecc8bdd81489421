"""Finds a text in a text. Pure."""

from __future__ import annotations

import re
from collections.abc import Sequence

Place = tuple[int, int]
"""Row and column, from 0."""


def find_all(text: str, wanted: str) -> list[Place]:
    """Where `wanted` begins, in order, without overlaps; capitals count only where `wanted` has some."""
    if not wanted:
        return []
    pattern = re.compile(re.escape(wanted), re.IGNORECASE if wanted == wanted.lower() else 0)
    return [(row, hit.start()) for row, line in enumerate(text.split("\n")) for hit in pattern.finditer(line)]


def nearest_index(found: Sequence[Place], start: Place, by: int = 0) -> int:
    """The index of the first place at or after `start` (`by` 0), after it (1) or before it (-1); around the end."""
    if by < 0:
        return next((n for n in range(len(found) - 1, -1, -1) if found[n] < start), len(found) - 1)
    return next((n for n, place in enumerate(found) if place > start or (not by and place == start)), 0)
