"""A roster: a table of the class, which says who handed in what, and who did not."""

from __future__ import annotations

import csv
import re
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from io import StringIO
from pathlib import Path

from tutor.errors import UsageError
from tutor.grade.learners import Learner

_FOLDER, _NUMBER, _EMAIL, _NAME = "folder", "number", "email", "name"
_COLUMNS = {
    _FOLDER: ("folder", "submission", "username", "login", "login id", "sis login id", "github", "github username"),
    _NUMBER: ("id", "number", "id number", "student id", "sid", "identifier", "userid", "sis user id"),
    _EMAIL: ("email", "email address", "e-mail", "mail"),
    _NAME: ("name", "full name", "student", "student name"),
}
"""By what a learner is known, the surest first, and how such a column may be headed."""

_FIRST_NAME, _LAST_NAME = ("first name", "given name"), ("last name", "surname", "family name")


class Roster:
    """The rows of a roster, found by a folder's name, a number, an e-mail address or a full name."""

    def __init__(self, rows: Sequence[Mapping[str, str]] = (), place: str = "the roster") -> None:
        self._rows = list(rows)
        self._place = place
        self._used: set[int] = set()
        self._found: dict[str, dict[str, list[int]]] = {kind: defaultdict(list) for kind in _COLUMNS}
        for index, row in enumerate(self._rows):
            for kind in _COLUMNS:
                for key in {_folded(value) for value in _keys(row, kind)} - {""}:
                    self._found[kind][key].append(index)

    @classmethod
    def read(cls, path: Path) -> Roster:
        """Read a CSV file with a header: folder, name, id and email, of which one suffices, in any order.

        Raises UsageError.
        """
        place = f"--roster {path}"
        try:
            content = path.read_bytes()
            text = content.decode("utf-16" if content[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig")
        except OSError as error:
            raise UsageError(f"{place}: cannot be read: {error.strerror}") from error
        except UnicodeDecodeError as error:
            raise UsageError(f"{place}: it is not UTF-8; save it as “CSV UTF-8”") from error
        try:
            header, rows = _read_rows(text)
        except csv.Error as error:
            raise UsageError(f"{place}: {error}") from error
        known = {*_FIRST_NAME, *_LAST_NAME, *(column for columns in _COLUMNS.values() for column in columns)}
        if not any(name.casefold() in known for name in header):
            raise UsageError(f"{place}: its first line names none of the columns folder, name, id and email")
        if not rows:
            raise UsageError(f"{place}: it lists no learner")
        return cls(rows, place)

    def learner(
        self, label: str, *, name: str = "", number: str = "", email: str = "", participant: str = ""
    ) -> Learner:
        """Return the learner who handed in under `label`, with what the roster says of them.

        `participant`: Moodle's number for one learner in one assignment. Raises UsageError if several rows fit.
        """
        index = self._find(label, name, number, email, participant)
        if index is None:
            return Learner(label, name or label, number or participant, email)
        self._used.add(index)
        return _from_row(self._rows[index], name or label, number or participant, email)

    def absent(self) -> Iterable[Learner]:
        """Yield the learners for whom `learner` was never called: they handed in nothing."""
        for index, row in enumerate(self._rows):
            if index not in self._used and _id_of(row):
                yield _from_row(row, _id_of(row), "", "")

    def _find(self, label: str, name: str, number: str, email: str, participant: str) -> int | None:
        known = self._with(_NUMBER, number) | self._with(_NUMBER, f"participant {participant}")
        words = label.split("-")
        ways = (
            *(self._with(kind, label) for kind in _COLUMNS),
            self._with(_EMAIL, email),
            self._with(_NAME, name),
            known,
            # A clone of GitHub Classroom is called ASSIGNMENT-USERNAME, and both may have hyphens.
            *(self._with(_FOLDER, "-".join(words[start:])) for start in range(1, len(words))),
            *(self._with(kind, label.partition("_")[0]) for kind in (_FOLDER, _NUMBER)),
        )
        rows = next(filter(None, ways), set())
        if len(rows) > 1:
            rows = rows & known or rows
        if len(rows) > 1:
            both = " and ".join(_id_of(self._rows[index]) for index in sorted(rows))
            raise UsageError(f"{self._place}: {label} may be {both}; add a column folder that says which is which")
        return next(iter(rows), None)

    def _with(self, kind: str, value: str) -> set[int]:
        return set(self._found[kind].get(_folded(value), ())) if value else set()


def _read_rows(text: str) -> tuple[list[str], list[dict[str, str]]]:
    """Return the header and the rows by header. The separator is the one that splits the header into most columns."""
    if text.startswith("sep="):  # Excel's
        text = text.partition("\n")[2]

    def read(separator: str) -> list[list[str]]:
        return list(csv.reader(StringIO(text, newline=""), delimiter=separator, skipinitialspace=True)) or [[]]

    header, *lines = max((read(separator) for separator in ",;\t"), key=lambda lines: len(lines[0]))
    names = [name.strip() for name in header]
    rows = [dict(zip(names, (cell.strip() for cell in line), strict=False)) for line in lines]
    # Canvas puts the maxima into a row of their own.
    return names, [row for row in rows if any(row.values()) and next(iter(row.values())) != "Points Possible"]


def _value(row: Mapping[str, str], columns: Sequence[str]) -> str:
    by_name = {key.casefold(): value for key, value in row.items()}
    return next((by_name[column] for column in columns if by_name.get(column)), "")


def _names(row: Mapping[str, str]) -> tuple[str, str]:
    """Return a first and a last name; the whole name as the last one if it does not say which is which."""
    name = _value(row, _COLUMNS[_NAME])
    if not name:
        return _value(row, _FIRST_NAME), _value(row, _LAST_NAME)
    last, comma, first = (part.strip() for part in name.partition(","))
    return (first, last) if comma else ("", name)


def _name_of(row: Mapping[str, str]) -> str:
    return " ".join(filter(None, _names(row)))


def _keys(row: Mapping[str, str], kind: str) -> Iterable[str]:
    """Yield by what a row may be found."""
    by_name = {key.casefold(): value for key, value in row.items()}
    yield from (by_name.get(column, "") for column in _COLUMNS[kind])
    if kind == _NAME:
        first, last = _names(row)
        if not first:
            first, _, last = last.rpartition(" ")
        yield f"{first} {last}"
        yield re.sub(r"[\W_]", "", f"{last}{first}")  # in the names of Canvas's files


def _id_of(row: Mapping[str, str]) -> str:
    return next((value for kind in (_FOLDER, _NUMBER, _EMAIL) if (value := _value(row, _COLUMNS[kind]))), _name_of(row))


def _from_row(row: Mapping[str, str], name: str, number: str, email: str) -> Learner:
    return Learner(
        _id_of(row),
        _name_of(row) or name,
        _value(row, _COLUMNS[_NUMBER]) or number,
        _value(row, _COLUMNS[_EMAIL]) or email,
        row,
    )


def _folded(text: str) -> str:
    return " ".join(text.split()).casefold()
