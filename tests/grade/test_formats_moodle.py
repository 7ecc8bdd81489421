"""`grade --format moodle`, read as Moodle's two importers read it."""

from __future__ import annotations

import csv
import html
import re
from dataclasses import replace
from io import StringIO
from pathlib import Path

import pytest

from tests.grade import made
from tests.grade.importers import moodle_import, moodle_worksheet, php_csv
from tutor.errors import UsageError
from tutor.grade.formats import render
from tutor.grade.learners import Learner
from tutor.grade.points import Points
from tutor.grade.results import Result

ITEMS = ("i1.1 Sensor Publisher", "i2.1 Parameterized Publisher")
USERS = {learner.email: learner.id for learner in made.LEARNERS}

WORKSHEET = """\
Identifier,"Full name","Email address",Status,Grade,"Maximum Grade","Grade can be changed",\
"Last modified (submission)","Last modified (grade)","Feedback comments"
"Participant 7101","Ada Lovelace",ada@example.org,"Submitted for grading - ",,50.00,Yes,"Friday, 20 November 2026",-,
"Participant 102","Zed Other",zed@example.org,Submitted,7.00,50.00,Yes,-,-,"<p class=""x"">well done</p>"
"Participant 7102","Brian Gerkey",brian@example.org,Submitted,,50.00,Yes,-,-,
"Participant 7103","Chloé d'Arc",chloe@example.org,Submitted,3.00,50.00,Yes,-,-,earlier
"""
PARTICIPANTS = {7101: "ada", 102: "zed", 7102: "brian", 7103: "chloe"}


def worksheet(text: str) -> dict[str, tuple[str, str]]:
    return moodle_worksheet(text, PARTICIPANTS, 50.0)


def shown(feedback: str) -> str:
    """Return what a browser shows of feedback."""
    assert not re.search(r"<(?!br>)", feedback), "no markup but line breaks"
    return html.unescape(feedback.replace("<br>", "\n"))


# --- Grades > Import ---


def test_a_file_for_the_gradebook() -> None:
    text = render(made.gradebook(), "moodle")
    found = moodle_import(text, USERS, "Email address", ITEMS)
    assert found == moodle_import(text, {each.number: each.id for each in made.LEARNERS}, "ID number", ITEMS)
    assert len(found) == len(made.LEARNERS) * len(ITEMS)
    assert found["ada", ITEMS[0]][0] == "10"
    assert found["brian", ITEMS[0]][0] == "1.67"
    assert found["chloe", ITEMS[0]][0] == "0"
    assert "homework (1).docx" in found["chloe", ITEMS[0]][1]
    assert found["chloe", ITEMS[1]] == (None, ""), "a fault is no zero"
    assert found["dev", ITEMS[1]] == (None, ""), "not graded yet"
    assert php_csv(text) == list(csv.reader(StringIO(text, newline=""))), "PHP reads what others read"


def test_feedback_says_why_and_what_next() -> None:
    found = moodle_import(render(made.gradebook(), "moodle"), USERS, "Email address", ITEMS)
    feedback = shown(found["brian", ITEMS[0]][1])
    assert "1.67 of 10 points" in feedback
    assert "passed: publishes" in feedback
    assert made.RATE.cause in feedback
    assert f"next step: {made.STEP}" in feedback
    silent = render(made.gradebook(steps=False), "moodle")
    assert made.STEP not in silent
    assert "explain" not in silent
    assert made.RATE.cause in silent


def test_feedback_is_text_whatever_a_submission_printed() -> None:
    found = moodle_import(render(made.gradebook(), "moodle"), USERS, "Email address", ITEMS)
    assert f"it printed {made.MARKUP}" in shown(found["mallory", ITEMS[0]][1])
    assert r"it printed \x1b[31mred\x07 \x00nul\x85 end" in shown(found["oscar", ITEMS[0]][1])
    for text in ('a "quoted" \\" backslash', "ends with a backslash \\", "&amp; <br>"):
        results = [made.failing(made.ADA, "i1.1", made.hostile(text))]
        found = moodle_import(render(made.gradebook(results), "moodle"), USERS, "Email address", ITEMS[:1])
        assert f"it printed {text}" in shown(found["ada", ITEMS[0]][1])


def test_no_cell_is_a_formula() -> None:
    for row in csv.reader(StringIO(render(made.gradebook(), "moodle"), newline="")):
        assert not [cell for cell in row if cell.startswith(("=", "+", "-", "@")) and cell != "-"]


def test_whom_moodle_would_not_find_is_named() -> None:
    unknown = [replace(made.BRIAN, email="", number=""), replace(made.ADA, number="")]
    with pytest.raises(UsageError, match="no email of Brian Gerkey \\(brian\\)"):
        render(made.gradebook([made.passing(learner) for learner in unknown]), "moodle")
    mixed = [replace(made.BRIAN, email=""), replace(made.ADA, number="")]
    with pytest.raises(UsageError, match="Moodle finds learners by"):
        render(made.gradebook([made.passing(learner) for learner in mixed]), "moodle")
    numbers = [replace(made.BRIAN, email=""), replace(made.ADA, email="")]
    text = render(made.gradebook([made.passing(learner) for learner in numbers]), "moodle")
    assert set(moodle_import(text, {"101": "ada", "102": "brian"}, "ID number", ITEMS[:1])) == {
        ("ada", ITEMS[0]),
        ("brian", ITEMS[0]),
    }


# --- the grading worksheet ---


def three() -> list[Result]:
    return [result for result in made.whole_class() if result.learner in (made.ADA, made.BRIAN, made.CHLOE)]


def test_a_worksheet_is_filled() -> None:
    text = render(made.gradebook(three()), "moodle", WORKSHEET)
    found = worksheet(text)
    assert found["ada"][0] == "50"
    assert found["brian"][0] == "29.17", "11.67 of 20, of 50"
    assert made.RATE.cause in shown(found["brian"][1])
    assert "1.67 of 10 points" in shown(found["brian"][1])
    assert found["chloe"] == ("3.00", "earlier"), "what could not all be judged stays"
    before, after = WORKSHEET.splitlines(), text.splitlines()
    assert len(before) == len(after)
    assert [after[index] for index in (0, 2, 4)] == [before[index] for index in (0, 2, 4)], "to the byte"
    assert "<script" not in text


def test_a_worksheet_without_comments() -> None:
    sheet = WORKSHEET.replace(',"Feedback comments"', ',"Something else"')
    text = render(made.gradebook(three()), "moodle", sheet)
    assert worksheet(text)["ada"] == ("50", "")
    assert "1.67" not in text


def test_no_more_than_the_maximum(tmp_path: Path) -> None:
    (tmp_path / "points.toml").write_text("[i1.1]\nbonus = 5\n", encoding="utf-8")
    points = Points.read(tmp_path / "points.toml", made.course())
    text = render(made.gradebook([made.passing(made.ADA)], points=points), "moodle", WORKSHEET)
    grade, feedback = worksheet(text)["ada"]
    assert grade == "50", "Moodle skips a grade out of range"
    assert "15 of 10 points" in feedback


@pytest.mark.parametrize(
    "learner",
    [
        Learner("x", "?", "7101"),
        Learner("x", "?", "Participant 7101", "", {"Identifier": "Participant 7101"}),
        Learner("x", "?", "", "ADA@example.org"),
        Learner("x", "ada lovelace"),
        Learner("x", "?", "102", "ada@example.org"),
        Learner("x", "Ada Lovelace", "102", "", {"id": "102", "name": "Ada Lovelace"}),
    ],
)
def test_a_participant_is_found_by_number_email_or_name(learner: Learner) -> None:
    found = worksheet(render(made.gradebook([made.passing(learner)]), "moodle", WORKSHEET))
    assert {user: grade for user, (grade, _) in found.items()} == {"ada": "50", "zed": "7.00", "chloe": "3.00"}


def test_a_worksheet_without_names() -> None:
    sheet = (
        "Identifier,Status,Grade,Maximum Grade,Grade can be changed,Last modified (grade)\r\n"
        'Participant 7101,Submitted,,"50,00",Yes,-\r\n'
    )
    text = render(made.gradebook([made.failing(replace(made.ADA, number="7101"))]), "moodle", sheet)
    assert text == sheet.replace("Submitted,,", "Submitted,8.33,")


def test_whom_the_worksheet_does_not_have_is_named() -> None:
    with pytest.raises(UsageError) as caught:
        render(made.gradebook(), "moodle", WORKSHEET)
    assert made.EVE.name in str(caught.value)
    assert "Chloé" not in str(caught.value), "of whom nothing would be written"
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("sheet", "what"),
    [
        ("", "no column Grade"),
        (WORKSHEET.replace("Grade,", "Bewertung,", 1), "no column Grade"),
        (WORKSHEET.replace('"Maximum Grade"', "Scale"), "no column Maximum Grade"),
        (WORKSHEET.replace("50.00", "Good"), "Maximum Grade of Ada"),
    ],
)
def test_another_table_is_refused(sheet: str, what: str) -> None:
    with pytest.raises(UsageError, match=f"--gradebook.*{what}"):
        render(made.gradebook(three()), "moodle", sheet)
