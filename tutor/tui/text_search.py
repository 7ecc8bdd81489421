"""Text search for the editor. Pure."""

from __future__ import annotations

import re
from collections.abc import Sequence

Place = tuple[int, int]
"""Row and column, both from 0."""


def find_all(text: str, wanted: str) -> list[Place]:
    """Return where the matches begin, in order, without overlaps. Case counts only if `wanted` contains capitals."""
    if not wanted:
        return []
    pattern = re.compile(re.escape(wanted), re.IGNORECASE if wanted == wanted.lower() else 0)
    return [(row, hit.start()) for row, line in enumerate(text.split("\n")) for hit in pattern.finditer(line)]


def nearest_index(found: Sequence[Place], start: Place, by: int = 0) -> int:
    """Return the index of the match nearest to `start`: at or after it (`by` 0), after (1) or before it (-1); wraps."""
    if by < 0:
        return next((n for n in range(len(found) - 1, -1, -1) if found[n] < start), len(found) - 1)
    return next((n for n, place in enumerate(found) if place > start or (not by and place == start)), 0)
