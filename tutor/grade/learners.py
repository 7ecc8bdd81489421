"""The learners of a class: who handed in what, and what a roster says of them."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tutor.errors import UsageError

_FOLDER_COLUMNS = ("folder", "submission", "username", "login", "login id", "sis login id", "github", "github username")
_NAME_COLUMNS = ("name", "full name", "student", "student name")
_NUMBER_COLUMNS = ("id", "number", "id number", "student id", "sid", "identifier", "userid")
_EMAIL_COLUMNS = ("email", "email address", "e-mail", "mail")

_MAX_ID = 100


@dataclass(frozen=True, slots=True)
class Learner:
    """One learner. `id` names the folder in the results: unique in a class, whatever the file system.

    `name` is shown to people. `number` and `email` are what the school's system knows the learner by; empty if unknown.
    `columns`: the learner's row of the roster.
    """

    id: str
    name: str
    number: str = ""
    email: str = ""
    columns: Mapping[str, str] = field(default_factory=dict)


class Roster:
    """The rows of a roster, found by a folder's name, a number, an e-mail address or a full name."""

    def __init__(self, rows: Sequence[Mapping[str, str]] = ()) -> None:
        self._rows = list(rows)
        self._used: set[int] = set()
        self._by_key: dict[str, int] = {}
        for columns in (_FOLDER_COLUMNS, _NUMBER_COLUMNS, _EMAIL_COLUMNS, _NAME_COLUMNS):
            for index, row in enumerate(self._rows):
                if value := _value(row, columns):
                    self._by_key.setdefault(value.casefold(), index)

    @classmethod
    def read(cls, path: Path) -> Roster:
        """Read a CSV file with a header: folder, name, id and email, of which one suffices, in any order.

        Raises UsageError.
        """
        try:
            text = path.read_text(encoding="utf-8-sig")
        except (OSError, UnicodeDecodeError) as error:
            reason = getattr(error, "strerror", None) or "it is not UTF-8"
            raise UsageError(f"--roster {path}: cannot be read: {reason}") from error
        try:
            dialect = csv.Sniffer().sniff(text.partition("\n")[0], ",;\t")
        except csv.Error:
            dialect = csv.excel
        rows = [
            {str(key).strip(): (value or "").strip() for key, value in row.items() if isinstance(value, str | None)}
            for row in csv.DictReader(text.splitlines(), dialect=dialect)
        ]
        known = {*_FOLDER_COLUMNS, *_NAME_COLUMNS, *_NUMBER_COLUMNS, *_EMAIL_COLUMNS}
        if not rows or not any(key.casefold() in known for key in rows[0]):
            raise UsageError(f"--roster {path}: its first line names none of the columns folder, name, id and email")
        return cls(rows)

    def learner(self, label: str, *, name: str = "", number: str = "", email: str = "") -> Learner:
        """Return the learner who handed in under `label`, with what the roster says of them."""
        keys = (label, number, email, name, *re.split(r"[_ ]", label, maxsplit=1)[:1])
        index = next((self._by_key[key.casefold()] for key in keys if key and key.casefold() in self._by_key), None)
        if index is None:
            return Learner(label, name or label, number, email)
        self._used.add(index)
        return _from_row(self._rows[index], label, name, number, email)

    def absent(self) -> Iterable[Learner]:
        """Yield the learners for whom `learner` was never called: they handed in nothing."""
        for index, row in enumerate(self._rows):
            if index not in self._used:
                label = next(filter(None, (_value(row, kind) for kind in _LABELS)), "")
                if label:
                    yield _from_row(row, label, "", "", "")


_LABELS = (_FOLDER_COLUMNS, _NUMBER_COLUMNS, _EMAIL_COLUMNS, _NAME_COLUMNS)


def _from_row(row: Mapping[str, str], label: str, name: str, number: str, email: str) -> Learner:
    return Learner(
        label,
        _value(row, _NAME_COLUMNS) or name or label,
        _value(row, _NUMBER_COLUMNS) or number,
        _value(row, _EMAIL_COLUMNS) or email,
        row,
    )


def _value(row: Mapping[str, str], columns: Sequence[str]) -> str:
    by_name = {key.casefold(): value for key, value in row.items()}
    return next((by_name[column] for column in columns if by_name.get(column)), "")


def with_unique_ids(learners: Iterable[Learner]) -> list[Learner]:
    """Return the learners with ids that can name folders, and differ even where upper and lower case do not."""
    from dataclasses import replace

    taken: set[str] = set()
    result = []
    for learner in learners:
        clean = safe_name(learner.id)
        unique, count = clean, 1
        while unique.casefold() in taken:
            count += 1
            unique = f"{clean}-{count}"
        taken.add(unique.casefold())
        result.append(replace(learner, id=unique))
    return result


def safe_name(text: str) -> str:
    """Return a name for a folder: printable, without separators, neither hidden nor empty, of limited length."""
    clean = "".join(
        character if character.isprintable() and character not in '/\\:*?"<>|' else "_" for character in text
    )
    return clean.strip().lstrip(".").encode()[:_MAX_ID].decode(errors="ignore").strip() or "unnamed"
