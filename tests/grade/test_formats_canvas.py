"""`grade --format canvas`, read as Canvas's importer reads it."""

from __future__ import annotations

import csv
from dataclasses import replace
from io import StringIO
from pathlib import Path

import pytest

from tests.grade import made
from tests.grade.importers import CanvasStudent, canvas
from tutor.errors import UsageError
from tutor.grade.formats import render
from tutor.grade.learners import Learner
from tutor.grade.points import Points
from tutor.grade.results import Result

STUDENTS = [
    CanvasStudent(9000101, "Ada Lovelace", "Lovelace, Ada", "S101", "ada"),
    CanvasStudent(9000102, "Brian Gerkey", "Gerkey, Brian", "102", "brian@example.org"),
    CanvasStudent(9000103, "Chloé d'Arc", "d'Arc, Chloé", "S103", "chloe"),
    CanvasStudent(9000999, "Zed Other", "Other, Zed", "S999", "zed"),
]
ASSIGNMENTS = {11: "i1.1 Sensor Publisher", 21: "i2.1: parameters", 99: "Essay"}

EXPORT = """\
Student,ID,SIS User ID,SIS Login ID,Section,Notes,i1.1 Sensor Publisher (11),i2.1: parameters (21),Essay (99),\
Labs Current Score,Final Score
,,,,,,Manual Posting,,,,
    Points Possible,,,,,,10.00,100.00,5.00,(read only),(read only)
"Lovelace, Ada",9000101,S101,ada,Lab 1,"said ""hi""
twice",,,4.00,80.00,80.00
"Gerkey, Brian",9000102,102,brian@example.org,Lab 1,,EX,N/A,3.00,,
"d'Arc, Chloé",9000103,S103,chloe,Lab 2,,1.00,77.00,2.00,,
"Other, Zed",9000999,S999,zed,Lab 2,,7.00,7.00,7.00,"7,00",
"""


def in_canvas(text: str) -> dict[tuple[int | str, int | str], str]:
    upload = canvas(text, STUDENTS, ASSIGNMENTS)
    assert not upload.new_students
    return upload.grades


def three() -> list[Learner]:
    return [made.ADA, made.BRIAN, made.CHLOE]


def results_of_three() -> list[Result]:
    return [result for result in made.whole_class() if result.learner in three()]


def test_a_new_gradebook() -> None:
    text = render(made.gradebook(), "canvas")
    upload = canvas(text, [], {})
    i1_1, i2_1 = "i1.1 Sensor Publisher", "i2.1 Parameterized Publisher"
    assert upload.maxima == {i1_1: "10", i2_1: "10"}
    assert len(upload.new_students) == len(made.LEARNERS)
    assert upload.grades["Brian Gerkey", i1_1] == "1.67"
    assert upload.grades["Brian Gerkey", i2_1] == "10"
    assert upload.grades["Chloé d'Arc", i1_1] == "0"
    assert upload.grades["Chloé d'Arc", i2_1] == "", "a fault is no zero"
    assert not [cell for row in csv.reader(StringIO(text)) for cell in row if cell.startswith(("=", "+", "-", "@"))]


def test_a_new_gradebook_finds_students_by_the_numbers_of_their_own_system() -> None:
    learners = {
        "its own number, from the name of a file": (Learner("x", "lovelaceada", "9000101"), 9000101),
        "a number of the school's": (Learner("x", "?", "102", "", {"id": "102", "email": ""}), 9000102),
        "a number that is somebody else's in Canvas": (
            Learner("x", "?", "9000999", "chloe", {"number": "9000999", "email": "chloe"}),
            9000103,
        ),
        "a roster that Canvas exported": (
            Learner("x", "?", "9000103", "", {"Student": "?", "ID": "9000103", "SIS Login ID": "chloe"}),
            9000103,
        ),
        "a name": (Learner("x", "Zed Other"), 9000999),
    }
    for why, (learner, student) in learners.items():
        assert [who for who, _ in in_canvas(render(made.gradebook([made.passing(learner)]), "canvas"))] == [student], (
            why
        )


def test_a_learner_cannot_change_the_maxima() -> None:
    name = Learner("x", "Points Possible 0")
    upload = canvas(render(made.gradebook([made.passing(name)]), "canvas"), [], {})
    assert list(upload.maxima.values()) == ["10"]
    assert len(upload.new_students) == 1


def test_an_export_is_filled() -> None:
    text = render(made.gradebook(results_of_three()), "canvas", EXPORT)
    grades = in_canvas(text)
    assert (grades[9000101, 11], grades[9000101, 21]) == ("10", "100"), "scaled to the points of the assignment"
    assert (grades[9000102, 11], grades[9000102, 21]) == ("EX", "N/A")
    assert (grades[9000103, 11], grades[9000103, 21]) == ("0", "77.00"), "what could not be judged stays"
    before, after = EXPORT.splitlines(), text.splitlines()
    assert len(before) == len(after)
    untouched = ("Student", ",,", "    Points", '"Gerkey', '"Other')
    assert [line for line in after if line.startswith(untouched)] == [
        line for line in before if line.startswith(untouched)
    ]
    assert {key: grade for key, grade in grades.items() if key[1] == 99} == {
        key: grade for key, grade in in_canvas(EXPORT).items() if key[1] == 99
    }


def test_bonus_points_go_beyond_the_maximum(tmp_path: Path) -> None:
    (tmp_path / "points.toml").write_text("[i1.1]\nbonus = 2\n[i2.1]\nbonus = 1\n", encoding="utf-8")
    points = Points.read(tmp_path / "points.toml", made.course())
    results = [made.passing(made.ADA), made.passing(made.ADA, "i2.1")]
    grades = in_canvas(render(made.gradebook(results, points=points), "canvas", EXPORT))
    assert (grades[9000101, 11], grades[9000101, 21]) == ("12", "130")


def test_an_export_with_semicolons_first_names_and_other_line_ends() -> None:
    export = (
        "LastName;FirstName;ID;SIS Login ID;Section;Sensor Publisher (11)\r\n"
        "    Points Possible;;;;;20,00\r\n"
        "Lovelace;Ada;9000101;ada;Lab 1;3,50\r\n"
        "Other;Zed;9000999;zed;Lab 1;7,50\r\n"
    )
    learner = replace(made.ADA, number="", email="", columns={})
    text = render(made.gradebook([made.failing(learner)]), "canvas", export)
    assert text == export.replace("3,50", "3.33")


@pytest.mark.parametrize(
    "learner",
    [
        Learner("x", "?", "9000101"),
        Learner("x", "?", "S101"),
        Learner("x", "?", "", "ADA"),
        Learner("ada", "?"),
        Learner("x", "ada  lovelace"),
        Learner("x", "Lovelace, Ada"),
        Learner("x", "lovelaceada", "5"),
        Learner("x", "?", "9000999", "ada", {"student number": "9000999", "email": "ada"}),
        Learner("x", "?", "", "", {"SIS User ID": "S101"}),
    ],
)
def test_a_student_is_found_by_all_that_canvas_knows(learner: Learner) -> None:
    gradebook = made.gradebook([made.passing(learner)])
    changed = {
        key: grade
        for key, grade in in_canvas(render(gradebook, "canvas", EXPORT)).items()
        if in_canvas(EXPORT)[key] != grade
    }
    assert changed == {(9000101, 11): "10"}


def test_a_name_that_canvas_made_a_formula_of_is_found() -> None:
    export = EXPORT.replace('"Lovelace, Ada"', '"=""=cmd|\' /C calc\'!A0"""')
    text = render(made.gradebook([made.passing(replace(made.EVE, number="", email=""))]), "canvas", export)
    assert in_canvas(text)[9000101, 11] == "10"


def test_who_and_what_is_not_there_is_named() -> None:
    with pytest.raises(UsageError) as learners:
        render(made.gradebook(), "canvas", EXPORT)
    for learner in (made.EVE, made.MALLORY):
        assert learner.name in str(learners.value)
    assert "\n" not in str(learners.value)
    assert "\x1b" not in str(learners.value)
    assert "Ada" not in str(learners.value)
    with pytest.raises(UsageError, match=r"i2\.1 Parameterized Publisher"):
        render(made.gradebook(results_of_three()), "canvas", EXPORT.replace("i2.1:", "i2.10"))
    with pytest.raises(UsageError, match=r"no single one, is called i1\.1"):
        render(made.gradebook(results_of_three()), "canvas", EXPORT.replace("Essay (", "i1.1 Sensor Publisher ("))


def test_two_learners_are_not_one_student() -> None:
    twins = [made.passing(Learner("one", "Ada Lovelace")), made.failing(Learner("two", "Ada Lovelace"))]
    with pytest.raises(UsageError, match="Ada Lovelace \\(two\\)"):
        render(made.gradebook(twins), "canvas", EXPORT)


@pytest.mark.parametrize("text", ["", "a,b\n1,2\n", "Identifier,Full name,Grade\n", 'Student,ID\n"x'])
def test_another_table_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="--gradebook"):
        render(made.gradebook(results_of_three()), "canvas", text)


def test_an_assignment_that_begins_with_the_id_is_enough_but_not_with_another_id() -> None:
    export = EXPORT.replace("i1.1 Sensor Publisher (11)", "I1.1: once more (11)").replace("Essay (", "i1.10 more (")
    text = render(made.gradebook(results_of_three()), "canvas", export)
    assert canvas(text, STUDENTS, ASSIGNMENTS).grades[9000101, 11] == "10"
