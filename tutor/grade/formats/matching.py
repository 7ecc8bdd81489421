"""Finds which row of a system's table is that of which learner."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterable, Mapping, Sequence

from tutor.errors import UsageError
from tutor.grade.learners import Learner
from tutor.report.plain import one_line

Keys = Callable[[Learner], Iterable[str]]
"""Returns by what a learner may be known in some columns."""


class Finder:
    """Finds the row of a learner by one kind of key after another: the first that only one row has decides."""

    def __init__(self) -> None:
        self._kinds: list[tuple[Mapping[str, set[int]], Keys]] = []

    def add(self, rows: Mapping[int, Iterable[str]], keys: Keys) -> None:
        """Add a kind of key: those of each row, and those of a learner. Upper and lower case are the same."""
        index: dict[str, set[int]] = {}
        for row, row_keys in rows.items():
            for key in filter(None, row_keys):
                index.setdefault(key.casefold(), set()).add(row)
        self._kinds.append((index, keys))

    def rows_of(self, learners: Sequence[Learner]) -> dict[str, int]:
        """Return the row of every learner, by the learner's id. Raises UsageError, naming those who have none."""
        found = {learner.id: self._find(learner) for learner in learners}
        owners: dict[int, list[str]] = {}
        for learner_id, row in found.items():
            if row is not None:
                owners.setdefault(row, []).append(learner_id)
        rows = {ids[0]: row for row, ids in owners.items() if len(ids) == 1}
        lost = [learner for learner in learners if learner.id not in rows]
        if lost:
            raise UsageError(
                f"--gradebook: no row, or no single one, is that of {names_of(lost)}",
                "--roster can say which id and email they have there",
            )
        return rows

    def _find(self, learner: Learner) -> int | None:
        for index, keys in self._kinds:
            rows = set[int]().union(*(index.get(key.casefold(), ()) for key in keys(learner) if key))
            if len(rows) == 1:
                return rows.pop()
        return None


def names_of(learners: Sequence[Learner]) -> str:
    """Return the names of learners, with the folders of those who have another name, as one line."""
    texts = (learner.name if learner.name == learner.id else f"{learner.name} ({learner.id})" for learner in learners)
    return ", ".join(one_line(text) for text in texts)


def name_keys(name: str) -> list[str]:
    """Return the keys of a full name.

    "Ada Lovelace" and "Lovelace, Ada" have one in common, and so have "Lovelace, Ada" and the "lovelaceada" that Canvas
    makes of it in names of files.
    """
    words = re.findall(r"\w+", unicodedata.normalize("NFKC", name).casefold())
    joined = ["".join(words)] if "," in name or len(words) == 1 else []
    return [" ".join(sorted(words)), *joined]


def number_is_from(learner: Learner, *columns: str) -> bool:
    """Whether a learner's number may be what a system has in one of `columns`.

    It is not if it comes from another column of a roster: the same number could be somebody else's there.
    """
    others = {value for name, value in learner.columns.items() if name.strip().casefold() not in columns}
    named = {value for name, value in learner.columns.items() if name.strip().casefold() in columns}
    return learner.number in named or learner.number not in others
