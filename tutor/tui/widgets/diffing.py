"""A unified diff of two texts: removed lines (-), added lines (+) and their context."""

from __future__ import annotations

import difflib

from tutor.tui.widgets.line_view import Piece, Row

_CONTEXT_LINES = 3
"""Lines of context around each change."""


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
