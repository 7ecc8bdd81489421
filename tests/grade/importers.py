"""How Canvas and Moodle read a CSV, by the rules of their importers: no code of ours is used here."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from io import StringIO


@dataclass
class CanvasStudent:
    id: int
    name: str
    sortable_name: str
    sis_id: str = ""
    login: str = ""


@dataclass
class CanvasUpload:
    """What Canvas takes out of an upload: grades by student and assignment, -1, -2, … for new ones; and maxima."""

    grades: dict[tuple[int | str, int | str], str] = field(default_factory=dict)
    maxima: dict[int | str, str] = field(default_factory=dict)
    new_students: list[str] = field(default_factory=list)


def canvas(text: str, students: Sequence[CanvasStudent], assignments: Mapping[int, str]) -> CanvasUpload:
    """Read as lib/gradebook_importer.rb does: `assignments` are titles by id."""
    first_lines = text.splitlines()[:3]
    counts = {";": {line.count(";") for line in first_lines}, ",": {line.count(",") for line in first_lines}}
    fields = {separator: found.pop() if len(found) == 1 else 0 for separator, found in counts.items()}
    rows = csv.reader(StringIO(text, newline=""), delimiter=";" if fields[";"] > fields[","] else ",", strict=True)
    header, *lines = [[_normal(cell) for cell in row] for row in rows if not re.fullmatch("[;, ]+", ",".join(row))]
    assert len(header) > 3, "InvalidHeaderRow"
    assert "Student" in header[0], "InvalidHeaderRow"
    assert "ID" in header[1], "InvalidHeaderRow"
    known = 3
    sis_column = login_column = None
    if re.search(r"SIS\s+Login\s+ID", header[2]):
        login_column, known = 2, 4
    elif re.search(r"SIS\s+User\s+ID", header[2]) and re.search(r"SIS\s+Login\s+ID", header[3]):
        sis_column, login_column, known = 2, 3, 5
    assert "Section" in header[known - 1], "InvalidHeaderRow"
    columns: dict[int | str, int] = {}
    for index, title in enumerate(header[known:], known):
        if re.search(r"(Current|Final|Override) (Score|Points|Grade|Status)", title):
            continue
        match = re.fullmatch(r"(.*)\s\((\d+)\)", title, re.DOTALL)
        same = [number for number, name in assignments.items() if name == title]
        number = int(match[2]) if match and int(match[2]) in assignments else None
        columns[number if number is not None else same[0] if same else title] = index
    upload = CanvasUpload()
    for row in lines:
        if "Points Possible" in row[0]:
            upload.maxima = {assignment: row[index] for assignment, index in columns.items() if row[index]}
            continue
        if all(re.fullmatch(r"\s*(Muted|Manual Posting.*)?\s*", cell, re.IGNORECASE) for cell in row):
            continue
        who = _student(row, students, sis_column, login_column)
        if isinstance(who, str):
            upload.new_students.append(who)
        for assignment, index in columns.items():
            upload.grades[who, assignment] = row[index].strip()
    return upload


def _normal(cell: str) -> str:
    if not re.fullmatch(r"-?[0-9.,]+%?", cell):
        return cell
    *parts, last = re.split("[,.]", cell)
    return ".".join(["".join(parts), last]) if parts else last


def _student(
    row: Sequence[str], students: Sequence[CanvasStudent], sis_column: int | None, login_column: int | None
) -> int | str:
    digits = re.match(r"\d+", row[1])
    for student in students:
        if digits and student.id == int(digits[0]):
            return student.id
    for student in students:
        if sis_column is not None and row[sis_column] and student.sis_id == row[sis_column]:
            return student.id
    for student in students:
        if login_column is not None and row[login_column] and student.login == row[login_column]:
            return student.id
    for student in students:
        if row[0] in (student.name, student.sortable_name):
            return student.id
    return row[0]


def php_csv(text: str) -> list[list[str]]:
    """Read as PHP's fgetcsv does, with its escape character: a backslash takes a quotation mark's meaning away."""
    rows: list[list[str]] = []
    cells: list[str] = []
    cell, quoted, index = "", False, 0
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    while index < len(text):
        character = text[index]
        if quoted and character == "\\" and index + 1 < len(text):
            cell += text[index : index + 2]
            index += 2
            continue
        if character == '"' and quoted and text[index + 1 : index + 2] == '"':
            cell += '"'
            index += 1
        elif character == '"' and (quoted or not cell):
            quoted = not quoted
        elif character == "," and not quoted:
            cells.append(cell)
            cell = ""
        elif character == "\n" and not quoted:
            rows.append([*cells, cell])
            cells, cell = [], ""
        else:
            cell += character
        index += 1
    assert not quoted, "the last cell does not end"
    return rows


def moodle_import(
    text: str, users: Mapping[str, str], map_from: str, items: Sequence[str]
) -> dict[tuple[str, str], tuple[str | None, str]]:
    """Read as grade/import/csv does: `users` by what `map_from` has; `items` are the columns mapped to grades."""
    header, *lines = php_csv(text)
    found = {}
    for line in lines:
        assert len(line) == len(header)
        user = users.get(line[header.index(map_from)].strip())
        assert user is not None, "User mapping error: the import is aborted"
        for item in items:
            grade = line[header.index(item)].strip()
            assert re.fullmatch(r"-?|\d+(\.\d+)?", grade), "bad grade: the import is aborted"
            feedback = line[header.index(f"Feedback for {item}")].strip()
            found[user, item] = (None if grade in ("", "-") else grade, feedback)
    return found


def moodle_worksheet(text: str, participants: Mapping[int, str], maximum: float) -> dict[str, tuple[str, str]]:
    """Read as mod/assign/feedback/offline does: grades and comments by user; a grade out of range is skipped."""
    header, *lines = php_csv(text)
    identifier, grade, modified = (header.index(name) for name in ("Identifier", "Grade", "Last modified (grade)"))
    assert modified >= 0
    comments = header.index("Feedback comments") if "Feedback comments" in header else None
    found = {}
    for line in lines:
        user = participants.get(int(line[identifier][len("Participant ") :]))
        if user is None or line[grade] == "":
            continue
        value = float(line[grade].replace(",", "."))
        if 0 <= value <= maximum:
            found[user] = (line[grade], line[comments] if comments is not None else "")
    return found
