"""The course as shipped."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tutor.content import Lesson, LessonFile, load_course
from tutor.content.lint import lint_course

README = Path(__file__).parents[2] / "README.md"

CRITERIA = {
    "i1.1": ("publishes range random echo rate sensor-name", "shutdown"),
    "i1.2": ("count rate summary restart gaps", "shutdown"),
    "i1.3": ("services operations divide-by-zero client", "shutdown"),
    "i2.1": ("defaults launch-params runtime-params validation timer", "atomic launch-validation shutdown"),
    "i2.2": ("starts topic namespace communicates", "shutdown"),
    "i2.3": ("blocks timer concurrent shutdown", "parallel shutdown-busy"),
}
"""Required and bonus criteria of each exercise of the course: stable ids, in reports and learners' progress files."""

FILES = {
    "i1.1": ("temperature_publisher.py",),
    "i1.2": ("message_stats.py",),
    "i1.3": ("calculator_server.py", "calculator_client.py"),
    "i2.1": ("parameterized_publisher.py",),
    "i2.2": ("my_launch.py",),
    "i2.3": ("concurrent_service.py",),
}


def lessons() -> list[Lesson]:
    return list(load_course().lessons)


def sources() -> list[tuple[str, LessonFile]]:
    return [(lesson.id, file) for lesson in lessons() for file in lesson.files]


def test_the_course_has_no_lint_problems() -> None:
    assert [str(problem) for problem in lint_course(load_course())] == []


def test_these_are_the_course_in_their_order_and_the_others_come_after() -> None:
    assert [lesson.id for lesson in lessons() if not lesson.beyond] == [*CRITERIA] == [*FILES]
    assert [lesson.id for lesson in lessons()][: len(CRITERIA)] == [*CRITERIA]
    assert {lesson.unit.partition(":")[0] for lesson in lessons() if lesson.beyond} <= {"Beyond"}


@pytest.mark.parametrize("id", CRITERIA)
def test_criteria_and_files_keep_their_names(id: str) -> None:
    lesson = load_course().find(id)
    required, bonus = CRITERIA[lesson.id]
    assert [criterion.id for criterion in lesson.criteria if not criterion.bonus] == required.split()
    assert [criterion.id for criterion in lesson.criteria if criterion.bonus] == bonus.split()
    assert tuple(file.name for file in lesson.files) == FILES[lesson.id]


def test_in_the_course_only_the_calculators_client_is_optional() -> None:
    optional = [(exercise, file.name) for exercise, file in sources() if exercise in FILES and not file.required]
    assert optional == [("i1.3", "calculator_client.py")]


@pytest.mark.parametrize(("exercise", "file"), sources(), ids=lambda value: getattr(value, "name", value))
def test_skeletons_and_solutions_are_plain_ros_code(exercise: str, file: LessonFile) -> None:
    for path in (file.skeleton, file.solution):
        source = path.read_text()
        if path.suffix == ".py":
            compile(source, path, "exec")
        assert not re.search(r"^\s*(?:from|import) (?:tutor|checks|lessons)\b", source, re.MULTILINE), path
    assert exercise not in FILES or "TODO" in file.skeleton.read_text()
    assert "TODO" not in file.solution.read_text()


@pytest.mark.parametrize("lesson", lessons(), ids=lambda lesson: lesson.id)
def test_every_skeleton_says_what_is_to_be_done(lesson: Lesson) -> None:
    assert any("TODO" in file.skeleton.read_text() for file in lesson.files)


@pytest.mark.parametrize(("exercise", "file"), sources(), ids=lambda value: getattr(value, "name", value))
def test_a_node_runs_as_a_script_and_as_a_console_script(exercise: str, file: LessonFile) -> None:
    if not file.name.endswith(".py") or file.name.endswith("launch.py"):
        pytest.skip("a launch file is run by the launch command, and other files are no programs")
    for path in (file.skeleton, file.solution):
        source = path.read_text()
        assert source.startswith("#!/usr/bin/env python3\n"), path
        assert "\ndef main() -> None:\n" in source, path
        assert source.endswith('\n\nif __name__ == "__main__":\n    main()\n'), path


def test_the_checklist_has_the_four_groups_of_the_course() -> None:
    groups = load_course().checklist.groups
    assert [(group.id, len(group.items)) for group in groups] == [
        ("rclpy-fundamentals", 4),
        ("communication-patterns", 4),
        ("configuration-and-launch", 4),
        ("concurrency", 3),
    ]


@pytest.mark.parametrize("lesson", lessons(), ids=lambda lesson: lesson.id)
def test_a_lesson_can_be_read_in_one_go(lesson: Lesson) -> None:
    assert len(lesson.body.splitlines()) <= 150


def test_every_item_of_a_lesson_is_shown_by_one_of_its_criteria() -> None:
    for lesson in lessons():
        assert set(lesson.checklist) == {item for criterion in lesson.criteria for item in criterion.shows}, lesson.id
    assert load_course().checklist.ready_title == "Ready for Advanced?"


def test_lines_of_skeletons_fit_the_code_page_of_the_app() -> None:
    """72 columns: at 120x36 the code page has 80, less those for the line numbers and the scrollbar."""
    skeletons = [file.skeleton for lesson in load_course().lessons for file in lesson.files]
    assert skeletons
    wide = [
        f"{path}:{number}"
        for path in skeletons
        for number, line in enumerate(path.read_text().splitlines(), start=1)
        if len(line) > 72 and path.name != "package.xml"  # its second line is the same everywhere
    ]
    assert not wide


def test_texts_say_what_a_check_does_with_the_source() -> None:
    # Reports quote lines, so it is read; it decides nothing.
    for text in [lesson.body for lesson in lessons()] + [README.read_text(encoding="utf-8")]:
        words = " ".join(text.split())
        assert "never reads" not in words
        assert re.search(r"never (decides )?by (the|your) source code, though a report may quote", words)
