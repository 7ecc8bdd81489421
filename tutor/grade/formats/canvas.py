"""Canvas's gradebook, as its importer reads it (instructure/canvas-lms, lib/gradebook_importer.rb)."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable
from io import StringIO

from tutor.content import Lesson
from tutor.errors import UsageError
from tutor.grade.formats.csv_table import as_text, number
from tutor.grade.formats.matching import Finder, name_keys, number_is_from
from tutor.grade.formats.template import Template, to_number
from tutor.grade.gradebook import Gradebook
from tutor.grade.learners import Learner

_MAXIMA = "Points Possible"
_ASSIGNMENT = re.compile(r"(?P<title>.*)\s\(\d+\)", re.DOTALL)
_FORMULA = re.compile(r'="(.*)"', re.DOTALL)
_LOCKED = ("EX", "N/A")


def render(gradebook: Gradebook, template: str | None = None) -> str:
    """Render a gradebook for Canvas to import; with `template`, the one that Canvas exported, filled.

    In a template, only the cells of these learners and exercises are filled, with points scaled to the Points Possible
    of the assignment. Who is excused (EX), or does not have the assignment (N/A), stays so; what could not be judged
    stays as it is. Without a template, Canvas asks which assignments the columns are, or creates them. Raises
    UsageError, naming the learners without a row and the exercises without a column.
    """
    return _new(gradebook) if template is None else _filled(gradebook, Template(template))


# --- a new one ---


def _new(gradebook: Gradebook) -> str:
    out = StringIO()
    writer = csv.writer(out, lineterminator="\n")
    titles = [f"{lesson.id} {lesson.title}" for lesson in gradebook.lessons]
    writer.writerow(["Student", "ID", "SIS User ID", "SIS Login ID", "Section", *titles])
    maxima = [number(gradebook.max_score(lesson)) for lesson in gradebook.lessons]
    writer.writerow([f"    {_MAXIMA}", "", "", "", "", *maxima])
    for learner in gradebook.learners:
        scores = [gradebook.score(learner, lesson) for lesson in gradebook.lessons]
        cells = ["" if score is None or score.score is None else number(score.score) for score in scores]
        name = learner.name.replace(_MAXIMA, _MAXIMA.lower())  # Canvas would take the row for that of the maxima
        writer.writerow([*(as_text(cell) for cell in (name, *_identity(learner))), *cells])
    return out.getvalue()


def _identity(learner: Learner) -> tuple[str, str, str, str]:
    """Return ID, SIS User ID, SIS Login ID and section.

    As an ID, the number of another system could be somebody else's: only those of Canvas go there.
    """
    columns = {name.strip().casefold(): value for name, value in learner.columns.items()}
    is_own = "sis login id" in columns or (not columns and not learner.email and learner.number.isdecimal())
    return (
        (columns.get("id") or learner.number) if is_own else "",
        columns.get("sis user id") or ("" if is_own else learner.number),
        columns.get("sis login id") or learner.email,
        columns.get("section", ""),
    )


# --- one that Canvas exported ---


def _filled(gradebook: Gradebook, table: Template) -> str:
    if table.column("Student", "LastName") != 0 or table.column("ID") is None:
        raise UsageError("--gradebook: Canvas's gradebook has the columns Student and ID; this is another table")
    maxima = next((row for row, cells in enumerate(table.rows) if cells and _MAXIMA in cells[0]), None)
    columns = _assignments(gradebook, table, maxima)
    scores = {
        (learner.id, lesson.id): score
        for learner in gradebook.learners
        for lesson in gradebook.lessons
        if (score := gradebook.score(learner, lesson)) is not None and score.score is not None
    }
    graded = [learner for learner in gradebook.learners if any(learner.id == owner for owner, _ in scores)]
    rows = _finder(table, maxima).rows_of(graded)
    for (learner, lesson), score in scores.items():
        row, column = rows[learner], columns[lesson]
        if table.cell(row, column).upper() in _LOCKED:
            continue
        possible = None if maxima is None else to_number(table.cell(maxima, column))
        scale = possible / score.max_score if possible and score.max_score else 1.0
        table.fill(row, column, number((score.score or 0.0) * scale))
    return table.render()


def _assignments(gradebook: Gradebook, table: Template, maxima: int | None) -> dict[str, int]:
    """Return the column of each exercise, by its id. Raises UsageError, naming those without one."""
    titles = {
        column: match["title"].strip().casefold()
        for column, name in enumerate(table.header)
        if (match := _ASSIGNMENT.fullmatch(name.strip()))
        and not (maxima is not None and "read only" in table.cell(maxima, column))
    }
    found = {lesson.id: _column_of(lesson, titles) for lesson in gradebook.lessons}
    used = list(found.values())
    lost = [f"{lesson.id} {lesson.title}" for lesson in gradebook.lessons if used.count(found[lesson.id]) > 1]
    lost += [f"{lesson.id} {lesson.title}" for lesson in gradebook.lessons if found[lesson.id] is None]
    if lost:
        raise UsageError(
            f"--gradebook: no assignment, or no single one, is called {', '.join(dict.fromkeys(lost))}",
            "give each in Canvas a title that begins with the exercise's id, or leave exercises out with --exercise",
        )
    return {lesson: column for lesson, column in found.items() if column is not None}


def _column_of(lesson: Lesson, titles: dict[int, str]) -> int | None:
    """Return the column of an assignment with the exercise's title, else the only one that begins with its id."""
    same = [f"{lesson.id} {lesson.title}".casefold(), lesson.id.casefold(), lesson.title.casefold()]
    begins = re.compile(rf"{re.escape(lesson.id.casefold())}(?![\w-]|\.\w)")
    equal = [column for column, title in titles.items() if title in same]
    columns = equal or [column for column, title in titles.items() if begins.match(title)]
    return columns[0] if len(columns) == 1 else None


def _finder(table: Template, maxima: int | None) -> Finder:
    rows = [row for row in range(1, len(table.rows)) if row != maxima and table.cell(row, 0)]
    ids, sis_ids, logins = table.column("ID"), table.column("SIS User ID"), table.column("SIS Login ID")
    finder = Finder()
    finder.add(
        {row: [f"id {table.cell(row, ids)}", f"sis {table.cell(row, sis_ids)}"] for row in rows},
        _numbers,
    )
    finder.add(
        {row: [table.cell(row, logins)] for row in rows},
        lambda learner: [_roster(learner, "sis login id"), learner.email, learner.id],
    )
    first_name = table.column("FirstName")
    finder.add(
        {row: name_keys(_name(table.cell(row, 0), table.cell(row, first_name))) for row in rows},
        lambda learner: name_keys(learner.name),
    )
    return finder


def _numbers(learner: Learner) -> Iterable[str]:
    if learner.number:
        yield f"sis {learner.number}"
        if number_is_from(learner, "id"):
            yield f"id {learner.number}"
    if sis_id := _roster(learner, "sis user id"):
        yield f"sis {sis_id}"


def _roster(learner: Learner, column: str) -> str:
    return next((value for name, value in learner.columns.items() if name.strip().casefold() == column), "")


def _name(last: str, first: str) -> str:
    """Return the name in a row, which Canvas has made a formula if it begins like one."""
    match = _FORMULA.fullmatch(last)
    name = match[1] if match is not None else last
    return f"{name}, {first}" if first else name
