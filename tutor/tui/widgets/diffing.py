"""Two texts compared: as a unified diff (removed lines -, added lines +, and their context), or side by side."""

from __future__ import annotations

import difflib
from itertools import zip_longest

from rich.cells import cell_len, chop_cells

from tutor.tui.widgets.line_view import Piece, Row

_CONTEXT_LINES = 3
"""Lines of context around each change."""

_NUMBER_WIDTH = 5
_SEPARATOR = " │ "
_MIN_COLUMN = 40
"""Narrower columns break too many lines of code."""


def diff_rows(before: str, after: str) -> tuple[list[Row], list[Piece]]:
    """Return the rows of the diff and their margins (line numbers in both texts); both empty for equal texts."""
    old, new = before.expandtabs(4).splitlines(), after.expandtabs(4).splitlines()
    rows: list[Row] = []
    margins: list[Piece] = []

    def add(a: int | None, b: int | None, mark: str, text: str, kind: str) -> None:
        numbers = f" {'' if a is None else a + 1:>4} {'' if b is None else b + 1:>4}  "
        margins.append((numbers, "gutter"))
        rows.append(((f"{mark} {text}", kind),))

    for number, group in enumerate(
        difflib.SequenceMatcher(None, old, new, autojunk=False).get_grouped_opcodes(_CONTEXT_LINES)
    ):
        if number:
            margins.append((" " * 12, "gutter"))
            rows.append((("⋯", "gutter"),))
        for tag, a, a_end, b, b_end in group:
            if tag == "equal":
                for step in range(a_end - a):
                    add(a + step, b + step, " ", old[a + step], "same")
                continue
            for line in range(a, a_end):
                add(line, None, "-", old[line], "removed")
            for line in range(b, b_end):
                add(None, line, "+", new[line], "added")
    return rows, margins


def column_width(width: int) -> int:
    """Return how wide each text is if two are shown side by side in this width; 0 if that is too narrow."""
    column = (width - len(_SEPARATOR)) // 2 - _NUMBER_WIDTH
    return column if column >= _MIN_COLUMN else 0


def side_by_side_rows(left: tuple[str, str], right: tuple[str, str], column: int) -> list[Row]:
    """Return two texts, each with its heading, as rows of two columns with corresponding lines beside each other."""
    old, new = (text.expandtabs(4).splitlines() for _, text in (left, right))
    rows = [_side_by_side((left[0], "type"), (right[0], "type"), column)]
    for tag, a, a_end, b, b_end in difflib.SequenceMatcher(None, old, new, autojunk=False).get_opcodes():
        kinds = ("same", "same") if tag == "equal" else ("removed", "added")
        for a_line, b_line in zip_longest(range(a, a_end), range(b, b_end)):
            mine = _broken(old[a_line], column) if a_line is not None else []
            ours = _broken(new[b_line], column) if b_line is not None else []
            for part, (one, other) in enumerate(zip_longest(mine, ours, fillvalue="")):
                numbers = (a_line, b_line) if part == 0 else (None, None)
                rows.append(_side_by_side((one, kinds[0]), (other, kinds[1]), column, *numbers))
    return rows


def _broken(line: str, column: int) -> list[str]:
    return chop_cells(line, column) or [""]


def _side_by_side(left: Piece, right: Piece, column: int, a: int | None = None, b: int | None = None) -> Row:
    (mine, mine_kind), (ours, ours_kind) = left, right
    numbers = [f"{'' if line is None else line + 1:>{_NUMBER_WIDTH - 1}} " for line in (a, b)]
    padding = " " * (column - cell_len(mine))
    return (
        (numbers[0], "gutter"),
        (mine + padding, mine_kind),
        (_SEPARATOR, "gutter"),
        (numbers[1], "gutter"),
        (ours, ours_kind),
    )


def same_line(before: str, after: str, row: int) -> int:
    """Return where line `row` (from 0) of `before` is in `after`; for a removed line, the place it had."""
    matcher = difflib.SequenceMatcher(None, before.splitlines(), after.splitlines(), autojunk=False)
    for tag, a, a_end, b, b_end in matcher.get_opcodes():
        if a <= row < a_end:
            return b + row - a if tag == "equal" else min(b + row - a, max(b, b_end - 1))
    return row


def count_changes(rows: list[Row]) -> tuple[int, int]:
    """Return the number of added and of removed lines in a diff."""
    kinds = [row[0][1] for row in rows if row]
    return kinds.count("added"), kinds.count("removed")
