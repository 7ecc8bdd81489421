"""Courses of one's own: making, packing and using them, and what the workspace remembers."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from tests.cli.conftest import Run

GREETING = Path(__file__).parents[1] / "courses" / "greeting"


@pytest.fixture
def greeting(home: Path) -> Path:
    return Path(shutil.copytree(GREETING, home / "greeting", ignore=shutil.ignore_patterns("__pycache__")))


def listed(run: Run, *options: str | Path) -> list[str]:
    """The ids that `list` shows."""
    return [exercise["id"] for exercise in json.loads(run("list", "--format", "json", *options).out)["exercises"]]


# --- using them ---


def test_a_workspace_remembers_the_course_that_was_started_in_it(run: Run, greeting: Path) -> None:
    assert "h1.1" not in listed(run)
    assert run("start", "h1.1", "--lessons", "greeting").code == 0
    assert listed(run)[-1] == "h1.1"
    assert run("hint", "h1.1").code == 0
    elsewhere = greeting.parent / "elsewhere"
    run("start", "i1.1", "--workspace", elsewhere)
    assert "h1.1" not in listed(run, "--workspace", elsewhere)


@pytest.mark.parametrize("called", ["hello", "greeting", "./greeting"])
def test_a_remembered_course_is_forgotten_by_its_name_or_folder(run: Run, greeting: Path, called: str) -> None:
    (greeting / "course.yaml").write_text("format: 1\nname: hello\n")
    run("start", "h1.1", "--lessons", "greeting")
    result = run("list", "--forget", called)
    assert result.code == 0
    assert "h1.1" not in result.out
    assert "h1.1" not in listed(run)


def test_a_remembered_course_that_is_gone_can_be_forgotten(run: Run, greeting: Path) -> None:
    run("start", "h1.1", "--lessons", "greeting", "--only")
    shutil.rmtree(greeting)
    assert run("list", "--forget", "greeting").err == ""
    assert run("list").err == ""
    assert listed(run)[0] == "i1.1"


def test_a_course_that_is_not_remembered_cannot_be_forgotten(run: Run, greeting: Path) -> None:
    result = run("list", "--forget", "greeting")
    assert (result.code, result.out) == (2, "")
    assert "--forget greeting: this workspace does not remember such a course; it remembers none" in result.err
    run("start", "h1.1", "--lessons", "greeting")
    assert f"it remembers {greeting}" in run("list", "--forget", "other").err


def test_the_command_that_start_advises_names_the_course_where_nothing_remembers_it(run: Run, greeting: Path) -> None:
    result = run("start", "h1.1", "here", "--lessons", "greeting")
    assert result.out.splitlines()[-1].endswith("check h1.1 here --lessons greeting")
    assert "h1.1" not in listed(run)


def test_a_remembered_course_that_is_gone_is_said_and_left_out(run: Run, greeting: Path) -> None:
    run("start", "h1.1", "--lessons", "greeting")
    shutil.rmtree(greeting)
    result = run("list")
    assert result.code == 0
    assert f"a course of this workspace cannot be used: {greeting}: there is no such folder or file" in result.err
    assert f"list --forget {greeting}` forgets it" in result.err
    assert "h1.1" not in result.out


def test_a_damaged_memory_is_set_aside(run: Run, greeting: Path, home: Path) -> None:
    run("start", "h1.1", "--lessons", "greeting")
    file = home / "ros_tutor_ws" / ".ros-tutor" / "courses.json"
    file.write_text("{")
    result = run("list")
    assert result.code == 0
    assert "the courses of this workspace could not be read (it is damaged)" in result.err
    assert not file.exists()


def test_the_environment_names_courses_too(run: Run, greeting: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_TUTOR_LESSONS", "greeting")
    assert listed(run)[-1] == "h1.1"
    run("start", "h1.1")
    monkeypatch.setenv("ROS_TUTOR_LESSONS", "")
    assert "h1.1" not in listed(run)
    monkeypatch.delenv("ROS_TUTOR_LESSONS")
    assert listed(run)[-1] == "h1.1"


def test_only_leaves_out_our_exercises_and_is_remembered(run: Run, greeting: Path) -> None:
    assert listed(run, "--lessons", "greeting", "--only") == ["h1.1"]
    run("start", "h1.1", "--lessons", "greeting", "--only")
    assert listed(run) == ["h1.1"]


def test_only_without_a_course_is_wrong_usage(run: Run) -> None:
    result = run("list", "--only")
    assert (result.code, result.out) == (2, "")
    assert "name a course with --lessons COURSE" in result.err


def test_each_of_several_courses_has_its_heading_and_its_ids(run: Run, greeting: Path, home: Path) -> None:
    other = shutil.copytree(greeting, home / "other")
    (other / "course.yaml").write_text("format: 1\nname: other\ntitle: Another course\n")
    result = run("list", "--lessons", "greeting", "--lessons", "other")
    lines = result.out.splitlines()
    assert lines[0] == "ROS 2, intermediate"
    assert lines[lines.index("Greeting") + 1].split()[0] == "h1.1"
    assert lines[lines.index("Another course") + 1].split()[0] == "other:h1.1"
    assert run("start", "other:h1.1", "--lessons", "greeting", "--lessons", "other").code == 0
    assert listed(run)[-2:] == ["h1.1", "other:h1.1"]


def test_with_our_course_alone_there_are_no_headings(run: Run) -> None:
    assert run("list").out.splitlines()[0].split()[0] == "i1.1"


def test_an_unknown_format_is_refused_in_one_line(run: Run, greeting: Path) -> None:
    (greeting / "course.yaml").write_text("format: 9\nname: greeting\n")
    result = run("list", "--lessons", "greeting")
    assert result.code == 3
    assert len(result.err.splitlines()) == 1
    assert "course.yaml:1: format: it has format 9, and this ros-tutor knows format 1" in result.err


# --- making them ---


def test_a_packed_course_is_used_like_its_folder(run: Run, greeting: Path, home: Path) -> None:
    result = run("author", "pack", "greeting")
    assert result.code == 0
    assert (home / "greeting.course.zip").is_file()
    shutil.rmtree(greeting)
    run("start", "h1.1", "--lessons", "greeting.course.zip")
    assert listed(run)[-1] == "h1.1"
    assert "hello" in run("solution", "h1.1").out


def test_a_course_without_course_yaml_is_not_packed(run: Run, greeting: Path, home: Path) -> None:
    (greeting / "course.yaml").unlink()
    result = run("author", "pack", "greeting")
    assert result.code == 2
    assert "course.yaml, which says `format: 1` and the `name` of the course" in result.err
    assert not list(home.glob("*.zip"))


def test_a_new_exercise_has_all_files_and_nothing_to_complain_about(run: Run, home: Path) -> None:
    result = run("author", "new", "x2.3", "Garden Gate", "--course", "gates")
    assert result.code == 0
    assert sorted(str(path.relative_to(home / "gates")) for path in (home / "gates").rglob("*") if path.is_file()) == [
        "checks/x2_3.py",
        "course.yaml",
        "lessons/x2_3/lesson.md",
        "lessons/x2_3/skeleton/garden_gate.py",
        "lessons/x2_3/solution/garden_gate.py",
        "submissions/x2_3/right/with-functions/expect.yaml",
        "submissions/x2_3/right/with-functions/garden_gate.py",
        "submissions/x2_3/wrong/other-topic.yaml",
        "submissions/x2_3/wrong/rate-as-period.yaml",
    ]
    check = run("author", "check", "--lessons", "gates", "--static")
    assert (check.code, check.out) == (0, "nothing is wrong: 1 exercise, nothing was run\n")


def test_a_second_exercise_joins_the_course_in_the_current_folder(
    run: Run, home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (home / "gates").mkdir()
    monkeypatch.chdir(home / "gates")
    run("author", "new", "x1.1", "Garden Gate")
    (home / "gates" / "course.yaml").write_text("format: 1\nname: mine\n")
    result = run("author", "new", "x1.2", "2 Gates")
    assert result.out.splitlines()[-1].endswith("author check x1.2")
    assert (home / "gates" / "course.yaml").read_text() == "format: 1\nname: mine\n"
    check = run("author", "check", "--static")
    assert (check.code, check.out) == (0, "nothing is wrong: 2 exercises, nothing was run\n")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["x1.1"], "say which exercise, and its title: "),
        (["1.1", "Gate"], "'1.1' cannot be the id of an exercise: use letters and two numbers, such as x1.1"),
        (["x1.1", 'The "Gate"'], "cannot be a title: use words"),
        (["x1.1", "Gate"], "there already is "),
    ],
)
def test_new_refuses_and_writes_nothing(run: Run, home: Path, words: list[str], message: str) -> None:
    lesson = home / "lessons" / "x1_1" / "lesson.md"
    lesson.parent.mkdir(parents=True)
    lesson.write_text("mine\n")
    result = run("author", "new", *words)
    assert result.code == 2
    assert message in result.err
    assert [path for path in home.rglob("*") if path.is_file()] == [lesson]
    assert lesson.read_text() == "mine\n"
