"""Moodle's grades: a CSV for its gradebook, or an assignment's offline grading worksheet, filled.

Follows moodle/moodle, grade/import/csv/classes/load_data.php and mod/assign/feedback/offline. Both show feedback as
HTML; and PHP reads a backslash before a quotation mark in a CSV as something else than everybody does.
"""

from __future__ import annotations

import csv
import html
import re
from collections.abc import Iterable
from io import StringIO

from tutor.errors import UsageError
from tutor.grade.formats.csv_table import as_text, number
from tutor.grade.formats.feedback_text import exercise_text
from tutor.grade.formats.matching import Finder, name_keys, names_of, number_is_from
from tutor.grade.formats.template import Template, to_number
from tutor.grade.gradebook import Gradebook
from tutor.grade.learners import Learner

_NO_GRADE = "-"
_EMAIL, _NUMBER = ("Email address", "Email"), ("ID number",)
_PARTICIPANT = re.compile(r"(?:\D*\s)?(\d+)")


def render(gradebook: Gradebook, template: str | None = None) -> str:
    """Render a CSV for Grades > Import, with a column for each exercise and one for its feedback.

    With `template`, the worksheet that the assignment's "Download grading worksheet" gives: the grade is the total of
    all exercises, scaled to Maximum Grade, which Moodle accepts no more than; the rows of others, and of those whose
    work could not all be judged, stay as they are. Raises UsageError, naming the learners whom Moodle would not find.
    """
    return _import(gradebook) if template is None else _filled(gradebook, Template(template))


def _import(gradebook: Gradebook) -> str:
    """Render the table. Moodle finds learners by one column of the teacher's choice, so one must be complete."""
    learners = gradebook.learners
    without_email = [learner for learner in learners if not learner.email]
    without_number = [learner for learner in learners if not learner.number]
    if without_email and without_number:
        fewest, what = (
            (without_email, "email") if len(without_email) <= len(without_number) else (without_number, "id number")
        )
        raise UsageError(
            f"Moodle finds learners by email or by id number; there is no {what} of {names_of(fewest)}",
            "give them in --roster, or the assignment's grading worksheet as --gradebook",
        )
    titles = [f"{lesson.id} {lesson.title}" for lesson in gradebook.lessons]
    out = StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(
        ["Full name", _EMAIL[0], _NUMBER[0], *(cell for title in titles for cell in (title, f"Feedback for {title}"))]
    )
    for learner in learners:
        cells = [as_text(cell).replace("\\", "/") for cell in (learner.name, learner.email, learner.number)]
        for lesson in gradebook.lessons:
            score = gradebook.score(learner, lesson)
            points = None if score is None else score.score
            cells.append(_NO_GRADE if points is None else number(points))
            cells.append("" if points is None else _feedback(gradebook, learner, lesson.id, "\n"))
        writer.writerow(cells)
    return out.getvalue()


def _filled(gradebook: Gradebook, table: Template) -> str:
    grade, maximum = table.column("Grade"), table.column("Maximum Grade")
    feedback = table.column("Feedback comments")
    if grade is None or maximum is None:
        missing = "Grade" if grade is None else "Maximum Grade"
        raise UsageError(
            f"--gradebook: this is no grading worksheet: it has no column {missing}",
            "download it from the assignment, with Moodle in English; an assignment graded on a scale has none",
        )
    totals = {learner.id: gradebook.total(learner) for learner in gradebook.learners}
    graded = [learner for learner in gradebook.learners if totals[learner.id].complete]
    rows = _finder(table).rows_of(graded)
    for learner in graded:
        row, total = rows[learner.id], totals[learner.id]
        most = to_number(table.cell(row, maximum))
        if most is None:
            raise UsageError(f"--gradebook: the Maximum Grade of {names_of([learner])} is not a number")
        share = min(total.score / total.max_score, 1.0) if total.max_score else 0.0
        table.fill(row, grade, number(share * most))
        if feedback is not None:
            texts = [_feedback(gradebook, learner, lesson.id, "<br>") for lesson in gradebook.lessons]
            table.fill(row, feedback, "<br><br>".join(texts))
    return table.render()


def _feedback(gradebook: Gradebook, learner: Learner, exercise: str, newline: str) -> str:
    """Return feedback as HTML, with `newline` between lines."""
    result = gradebook.results[learner.id, exercise]
    text = exercise_text(result, gradebook.points.score(result), steps=gradebook.steps)
    return html.escape(text).replace("\\", "&#92;").replace("\n", newline)


def _finder(table: Template) -> Finder:
    rows = range(1, len(table.rows))
    identifiers, emails, numbers = table.column("Identifier"), table.column(*_EMAIL), table.column(*_NUMBER)
    finder = Finder()
    finder.add(
        {row: _participant_keys(table.cell(row, identifiers), table.cell(row, emails)) for row in rows},
        _participant,
    )
    finder.add({row: [table.cell(row, emails)] for row in rows}, lambda learner: [learner.email])
    finder.add({row: [table.cell(row, numbers)] for row in rows}, lambda learner: [learner.number])
    full_names = table.column("Full name")
    finder.add({row: name_keys(table.cell(row, full_names)) for row in rows}, lambda learner: name_keys(learner.name))
    return finder


def _participant_keys(identifier: str, email: str) -> Iterable[str]:
    match = _PARTICIPANT.fullmatch(identifier)
    return (match[1], f"{match[1]} {email}") if match is not None else ()


def _participant(learner: Learner) -> Iterable[str]:
    """Return Moodle's number for a learner in the assignment, if it may be that, and no email says otherwise."""
    match = _PARTICIPANT.fullmatch(learner.number)
    if match is None or not number_is_from(learner, "identifier"):
        return ()
    return (f"{match[1]} {learner.email}", f"{match[1]} ") if learner.email else (match[1],)
