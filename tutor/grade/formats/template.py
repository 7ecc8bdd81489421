"""A table that a teacher's system has exported, in which some cells are filled."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from io import StringIO

from tutor.errors import UsageError

_DELIMITERS = ",;\t"


class Template:
    """The table; the first of `rows` is its header. A row in which nothing changes is rendered as it was, to the byte.

    Raises UsageError if it is not CSV.
    """

    def __init__(self, text: str) -> None:
        header, _, _ = text.partition("\n")
        self._delimiter = max(_DELIMITERS, key=header.count)
        self._ending = "\r\n" if header.endswith("\r") else "\n"
        self._texts: list[str] = []
        self.rows: list[list[str]] = []
        lines = list(StringIO(text, newline=""))
        reader = csv.reader(lines, delimiter=self._delimiter)
        start = 0
        try:
            for row in reader:
                self.rows.append(row)
                if len(row) > len(self.rows[0]):
                    raise csv.Error("it has more cells than the first line")
                self._texts.append("".join(lines[start : reader.line_num]))
                start = reader.line_num
        except csv.Error as error:
            raise UsageError(f"--gradebook: line {reader.line_num}: {error}") from error

    @property
    def header(self) -> Sequence[str]:
        """The names of the columns."""
        return self.rows[0] if self.rows else []

    def column(self, *names: str) -> int | None:
        """Return the first column with one of these names, in upper or lower case; None if there is none."""
        wanted = [name.casefold() for name in names]
        return next((index for index, name in enumerate(self.header) if name.strip().casefold() in wanted), None)

    def cell(self, row: int, column: int | None) -> str:
        """Return a cell, stripped; empty if there is none."""
        cells = self.rows[row]
        return cells[column].strip() if column is not None and column < len(cells) else ""

    def fill(self, row: int, column: int, text: str) -> None:
        """Change a cell."""
        cells = self.rows[row]
        cells += [""] * (column + 1 - len(cells))
        if cells[column] != text:
            cells[column] = text
            out = StringIO()
            csv.writer(out, delimiter=self._delimiter, lineterminator=self._ending).writerow(cells)
            self._texts[row] = out.getvalue()

    def render(self) -> str:
        """Return the table as CSV, as it was written: with its delimiter and line ends."""
        return "".join(self._texts)


def to_number(text: str) -> float | None:
    """Read a number as it is written in any language, "10.50" or "10,50"; None if it is none."""
    try:
        return float(text.strip().replace(",", "."))
    except ValueError:
        return None
