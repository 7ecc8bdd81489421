"""Courses with modules of the same names, loaded in one process, each keep their own."""

from __future__ import annotations

from pathlib import Path

from tests.content.conftest import make_course
from tutor.content import load_course
from tutor.engine.loading import load_catalogues, load_check
from tutor.mistakes.diagnosis import catalogues_of

CHECK = """
from checks import common
from checks.common import WORD
from tutor.judge.check import Check

assert common.WORD == WORD
CHECK = Check("x1.1", (), expected_reason=WORD, mistakes="checks.x1_1.mistakes")
"""

MISTAKES = """
from checks.common import WORD
from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Catalogue, Evidence, Found

CATALOGUE = Catalogue()

@CATALOGUE.mistake(WORD, explains=[Symptom.ENDED], evidence=Evidence.SYMPTOM, says="says", do="Do.")
def found(case):
    \"\"\"It is WORD.

    See it: `ros2 node list`.
    \"\"\"
    yield Found({})
"""


def make(root: Path, word: str) -> Path:
    """Make a course of this name whose check and mistakes have the word as well."""
    course = root / word
    make_course(course)
    (course / "course.yaml").write_text(f"format: 1\nname: {word}\n")
    (course / "checks" / "x1_1").mkdir(parents=True)
    (course / "checks" / "x1_1" / "__init__.py").write_text(CHECK)
    (course / "checks" / "x1_1" / "mistakes.py").write_text(MISTAKES)
    (course / "checks" / "common.py").write_text(f'WORD = "{word}"\n')
    return course


def test_two_courses_with_modules_of_the_same_names_keep_them_apart(tmp_path: Path) -> None:
    course = load_course([make(tmp_path, "lamps"), make(tmp_path, "doors")])
    lessons = [lesson for lesson in course.lessons if lesson.course]
    lamps, doors = map(load_check, lessons)
    assert (lamps.expected_reason, doors.expected_reason) == ("lamps", "doors")
    for check, word in ((lamps, "lamps"), (doors, "doors"), (load_check(lessons[0]), "lamps")):
        assert list(catalogues_of(check)[0].entries) == [word]
    assert [list(found.entries) for found in load_catalogues(course)][-2:] == [["lamps"], ["doors"]]
    assert load_check(lessons[0]) == lamps
