"""Test submissions as patches of the solution: what becomes what, and what is wrong with one that does not fit."""

from __future__ import annotations

from pathlib import Path

import pytest

from tutor.content import Course, load_course
from tutor.content.lint_submissions import find_bad_submissions
from tutor.content.patches import patched
from tutor.content.submissions import read_case

SOLUTION = """\
class Mover:
    def move(self, speed):
        if speed > 0:
            self.go(speed)
        return "/moved"


print("moved")
"""


@pytest.fixture
def course(lesson_folder: Path) -> Course:
    (lesson_folder / "solution" / "mover.py").write_text(SOLUTION)
    return load_course()


def write_patch(root: Path, text: str) -> Path:
    file = root / "submissions" / "x1_1" / "wrong" / "still.yaml"
    file.parent.mkdir(parents=True)
    file.write_text(f"says: it stands\nfails: [moves]\nmistake: no-publisher\nchange:\n{text}")
    return file


@pytest.mark.parametrize(
    ("change", "before", "after"),
    [
        ("- from: speed > 0\n  to: speed > 1\n", "speed > 0", "speed > 1"),
        ('- from: print("moved")\n', 'print("moved")', ""),
        ("- from: /moved\n  to: /stood\n  in: mover.py\n", "/moved", "/stood"),
        (
            "- from: |\n    if speed > 0:\n        self.go(speed)\n  to: self.go(speed)\n",
            "        if speed > 0:\n            self.go(speed)\n",
            "        self.go(speed)\n",
        ),
        (
            "- from: self.go(speed)\n  to: |\n    self.go(speed)\n    self.stop()\n",
            "            self.go(speed)\n",
            "            self.go(speed)\n            self.stop()\n",
        ),
    ],
)
def test_a_patch_changes_one_place_of_the_solution(
    course: Course, tmp_path: Path, change: str, before: str, after: str
) -> None:
    case = read_case(write_patch(tmp_path, change))
    assert patched(course.lessons[0], case.changes) == {"mover.py": SOLUTION.replace(before, after)}
    assert (str(case), case.expected.fails, case.expected.mistakes) == (
        "x1.1/wrong/still",
        ("moves",),
        {"": ("no-publisher",)},
    )


def test_changes_are_made_one_after_another(course: Course, tmp_path: Path) -> None:
    case = read_case(write_patch(tmp_path, "- from: /moved\n  to: /stood\n- from: /stood\n  to: /sat\n"))
    assert patched(course.lessons[0], case.changes)["mover.py"] == SOLUTION.replace("/moved", "/sat")


@pytest.mark.parametrize(
    ("change", "line", "text"),
    [
        ("- from: speed\n  to: x\n", 5, "change: the solution's mover.py has `speed` 3 times: name more of it"),
        ("- from: stand\n  to: x\n", 5, "change: the solution's mover.py has no `stand`"),
        ("- from: speed >\n  to: |\n    a\n    b\n", 5, "the solution's mover.py has no `speed >` as whole lines"),
        ("- from: /moved\n  to: x\n  in: walker.py\n", 5, "say with `in` which file it changes: mover.py"),
        ("- from: /moved\n  to: 0.5\n", 6, "change[1].to: 0.5 is read as a value, not as text: put it in quotes"),
        ("- to: x\n", 5, "change[1].from: this field is missing: say what of the solution changes"),
        ("- from: /moved\n  too: x\n", 6, "change[1].too: there is no such field"),
    ],
)
def test_a_patch_that_does_not_fit_is_a_problem_with_its_line(
    course: Course, tmp_path: Path, change: str, line: int, text: str
) -> None:
    file = write_patch(tmp_path, change)
    problems = [each for each in find_bad_submissions(tmp_path / "submissions", course, course.lessons) if each.line]
    assert [(each.file, each.line) for each in problems] == [(file, line)]
    assert text in problems[0].text
