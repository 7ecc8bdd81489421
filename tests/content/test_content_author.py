"""What `author check` verifies besides the lessons: checks, commands, test submissions, verdicts on our own code."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from tests.failures import failure
from tutor.content import Course, Lesson, load_course
from tutor.content.lint_checks import find_disagreements, find_stray_files
from tutor.content.lint_commands import find_bad_commands
from tutor.content.lint_submissions import find_bad_submissions
from tutor.content.proof import find_contradictions, unjudged_criteria
from tutor.content.submissions import read_expected
from tutor.errors import ContentError
from tutor.judge.check import Check, Criterion
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status, Verdict, fault, passed, skipped

FAILED = failure("a", "2 Hz", ("no spin", "it never spins", "spin"))


@pytest.fixture
def course(lesson_folder: Path) -> Course:
    checks = lesson_folder.parents[1] / "checks" / "x1_1"
    checks.mkdir(parents=True)
    (checks / "__init__.py").write_text('CHECK = None\nFILE = "mover.py"\n')
    return load_course()


def judge() -> Verdict:
    return passed("", "")


def check(*criteria: str, exercise: str = "x1.1", bonus: tuple[str, ...] = ("stops",)) -> Check:
    return Check(exercise, tuple(Criterion(each, judge, (), bonus=each in bonus) for each in criteria))


# --- lessons and checks ---


@pytest.mark.parametrize(
    ("exercise_check", "file", "text"),
    [
        (check("moves", "stops"), "", ""),
        (check("moves", "stops", exercise="x1.2"), "checks/x1_1/__init__.py", "it judges x1.2"),
        (check("moves"), "checks/x1_1/__init__.py", "the criterion stops of the lesson is not judged"),
        (
            check("moves", "stops", "jumps"),
            "lesson.md",
            "the criterion jumps is judged, but the lesson does not have it",
        ),
        (
            check("moves", "stops", bonus=()),
            "lesson.md",
            "the criterion stops is a bonus here and required in the check",
        ),
        (
            check("stops", "moves"),
            "lesson.md",
            "the criteria are in another order than in the check, which has stops, moves",
        ),
    ],
)
def test_disagreements_of_lesson_and_check_are_found(
    course: Course, exercise_check: Check, file: str, text: str
) -> None:
    found = list(find_disagreements(course.lessons[0], exercise_check))
    assert [problem.text for problem in found] == ([text] if text else [])
    assert all(str(problem.file).endswith(file) for problem in found)


def test_a_check_must_name_the_lessons_files(course: Course) -> None:
    lesson = course.lessons[0]
    lesson.check.write_text('FILE = "walker.py"\n')
    assert [problem.text for problem in find_disagreements(lesson, check("moves", "stops"))] == [
        "the file mover.py is named nowhere in it"
    ]
    lesson.check.with_name("facts.py").write_text('FILE = "mover.py"\n')
    assert list(find_disagreements(lesson, check("moves", "stops"))) == []


def test_stray_files_beside_lessons_and_checks_are_found(course: Course, lesson_folder: Path) -> None:
    root = lesson_folder.parents[1]
    assert list(find_stray_files(course, course.lessons)) == []
    for stray in ("lessons/notes.txt", "checks/x1_2.py", "checks/__init__.py"):
        (root / stray).touch()
    (root / "checks" / "__pycache__").mkdir()
    found = [str(problem.file.relative_to(root)) for problem in find_stray_files(course, course.lessons)]
    assert found == ["lessons/notes.txt", "checks/x1_2.py"]


# --- commands ---


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("python3 mover.py --ros-args \\\n    -p speed:=1.0  # faster", ""),
        ("python3 given.py", ""),
        ("ros2 launch my_package given.py", ""),
        ("ros2 run my_package mover", ""),
        ("ros-tutor check x1.1 --criterion moves", ""),
        ("python3 walker.py", "there is no file walker.py"),
        ("ros2 run my_package walker", "my_package has no program walker"),
        ("ros-tutor check x1.1 --criterion flies", "there is no criterion flies"),
        ("ros-tutor chek x1.1", "no such command"),
    ],
)
def test_commands_that_cannot_work_are_found(course: Course, line: str, text: str) -> None:
    lesson = replace(course.lessons[0], body=f"```bash\n{line}\n```\n\n```python\nopen('other.py')\n```\n")

    def usage(argv: list[str]) -> str:
        return "" if argv[0] == "check" else "no such command"

    found = [problem.text for problem in find_bad_commands(lesson, {"given.py"}, usage)]
    assert len(found) == bool(text)
    assert not text or found[0].endswith(f": {text}")


# --- test submissions ---

RIGHT = "says: right\npasses: all\n"
GOOD = {
    "x1_1/right/plain": RIGHT,
    "x1_1/wrong/moves": "says: it stands\nfails: [moves]\ncause: no spin\n",
    "x1_1/wrong/stops": "says: goes on\nbonus_failed: [stops]\ncause: {stops: [a, b]}\ngone: sleep 1\nros: bundled\n",
}


def lint_submissions(root: Path, course: Course, expectations: Mapping[str, str]) -> list[str]:
    """Write submissions with these expect.yaml files, and return the problems found in them."""
    for name, expect in expectations.items():
        folder = root / name
        folder.mkdir(parents=True)
        (folder / "mover.py").touch()
        (folder / "expect.yaml").write_text(expect)
    return [
        f"{problem.file.relative_to(root)}{problem.line_suffix}: {problem.text}"
        for problem in find_bad_submissions(root, course, course.lessons)
    ]


def test_a_mistake_that_has_no_page_is_a_problem(course: Course, tmp_path: Path) -> None:
    wrong = tmp_path / "x1_1/wrong/moves"
    wrong.mkdir(parents=True)
    (wrong / "mover.py").touch()
    (wrong / "expect.yaml").write_text("says: it stands\nfails: [moves]\nmistake: {moves: [never-spun, never-spum]}\n")
    found = [
        problem for problem in find_bad_submissions(tmp_path, course, course.lessons, ["never-spun"]) if problem.line
    ]
    assert [(problem.text, problem.hint, problem.line) for problem in found] == [
        ("mistake: there is no 'never-spum'", "did you mean never-spun?", 3)
    ]


def test_correct_submissions_have_no_problems(course: Course, tmp_path: Path) -> None:
    root = tmp_path / "submissions"
    root.mkdir()
    (root / "README.md").touch()
    assert lint_submissions(root, course, GOOD) == []


@pytest.mark.parametrize(
    ("name", "expect", "text"),
    [
        ("x1_1/wrong/a", "fails: [moves]\n", "says: this field is missing"),
        ("x1_1/wrong/a", "says: a\nfails: [moves]\nfail: [stops]\n", "expect.yaml:3: fail: there is no such field"),
        ("x1_1/wrong/a", "says: a\nfails: moves\n", "expect.yaml:2: fails: expected a list, found a text"),
        ("x1_1/wrong/a", "says: a\nfails: [moves]\ncause: [1]\n", "cause: expected a text or a list of texts, or one"),
        ("x1_1/right/a", "says: a\npasses: most\n", "passes: expected all, found 'most'"),
        ("x1_1/wrong/a", "says: a\nfails: [flies]\n", "fails: there is no criterion 'flies'"),
        ("x1_1/wrong/a", "says: a\nfails: [moves]\ncause: {flies: b}\n", "cause: there is no criterion 'flies'"),
        ("x1_1/wrong/a", "says: a\nfails: [stops]\n", "fails: stops is a bonus"),
        ("x1_1/wrong/a", "says: a\nbonus_failed: [moves]\n", "bonus_failed: moves is not a bonus"),
        ("x1_1/wrong/a", "says: a\nfails: [moves]\neither: [moves]\n", "moves is in fails and in another key"),
        ("x1_1/wrong/a", "says: a\neither: [moves]\n", "nothing fails, but this is a wrong submission"),
        ("x1_1/wrong/a", "says: a\npasses: all\nfails: [moves]\n", "a wrong submission must not pass"),
        ("x1_1/right/a", "says: a\n", "a right submission must pass"),
        ("x1_1/right/a", RIGHT + "either: [moves]\n", "moves does not have to pass, but this is a right submission"),
        ("x1_2/right/a", RIGHT, "x1_2: this belongs to no exercise"),
        ("x1_1/maybe/a", RIGHT, "x1_1/maybe: this is not a submission"),
    ],
)
def test_a_faulty_submission_is_reported(course: Course, tmp_path: Path, name: str, expect: str, text: str) -> None:
    (found,) = lint_submissions(tmp_path / "submissions", course, {**GOOD, name: expect})
    assert text in found


def test_stray_and_missing_files_of_submissions_are_found(course: Course, tmp_path: Path) -> None:
    root = tmp_path / "submissions"
    lint_submissions(root, course, GOOD)
    (root / "x1_1/right/empty").mkdir()
    (root / "x1_1/right/mover.py").touch()
    (root / "x1_1/right/plain/mover.py").unlink()
    assert [problem.text for problem in find_bad_submissions(root, course, course.lessons)] == [
        "there is no expect.yaml",
        "this is not a submission",
        "there is no mover.py",
    ]


def test_each_criterion_needs_a_passing_and_a_failing_submission(course: Course, tmp_path: Path) -> None:
    expectations = {"x1_1/right/plain": RIGHT + "bonus_failed: [stops]\n"}
    assert lint_submissions(tmp_path / "submissions", course, expectations) == [
        "x1_1/wrong: no submission breaks moves",
        "x1_1/right: no submission keeps stops",
    ]


def test_expect_yaml_is_parsed(tmp_path: Path) -> None:
    file = tmp_path / "expect.yaml"
    file.write_text("says: x\nfails: [a]\ncause: {a: one, b: [two, three]}\n")
    expected = read_expected(file)
    assert expected.fails == ("a",)
    assert expected.causes == {"a": ("one",), "b": ("two", "three")}
    file.write_text("says: x\ncause: one\n")
    assert read_expected(file).causes == {"": ("one",)}
    with pytest.raises(ContentError, match="cannot be read"):
        read_expected(tmp_path / "nowhere.yaml")


# --- verdicts on our own code ---


def result(lesson: Lesson, **verdicts: Verdict) -> ExerciseResult:
    criteria = tuple(CriterionResult(name, name, name == "stops", verdict, 1.0) for name, verdict in verdicts.items())
    return ExerciseResult(lesson.id, lesson.title, ("mover.py",), criteria, 1.0)


@pytest.mark.parametrize(
    ("kind", "moves", "stops", "text"),
    [
        ("solution", passed("", ""), passed("", ""), ""),
        ("solution", passed("", ""), FAILED, "stops does not pass (2 Hz | no spin: it never spins)"),
        ("solution", skipped("no"), passed("", ""), "moves does not pass (no)"),
        ("solution", fault("busy", "wait"), passed("", ""), ""),
        ("skeleton", FAILED, passed("", ""), ""),
        ("skeleton", FAILED, skipped("no"), ""),
        (
            "skeleton",
            FAILED,
            FAILED,
            "stops fails, but the lesson says that it is not open (2 Hz | no spin: it never spins)",
        ),
        ("skeleton", fault("busy", "wait"), passed("", ""), ""),
        ("skeleton", skipped("no"), skipped("no"), "no criterion fails"),
    ],
)
def test_verdicts_on_our_own_code_must_match_the_lesson(
    course: Course, kind: str, moves: Verdict, stops: Verdict, text: str
) -> None:
    lesson = course.lessons[0]
    judged = result(lesson, moves=moves, stops=stops)
    found = list(find_contradictions(lesson, kind, judged))
    assert [problem.text for problem in found] == ([text] if text else [])
    assert all(problem.file == lesson.folder / kind for problem in found)
    assert [c.id for c in unjudged_criteria(judged)] == (["moves"] if moves.status is Status.ERROR else [])


def test_a_skeleton_that_passes_an_open_criterion_is_found(course: Course) -> None:
    lesson = course.lessons[0]
    found = find_contradictions(lesson, "skeleton", result(lesson, moves=passed("", ""), stops=passed("", "")))
    assert [problem.text for problem in found] == [
        "moves passes, but the lesson says that it is open",
        "no criterion fails",
    ]
