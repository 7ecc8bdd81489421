"""Lints lessons together with their checks: that they agree, and that their folders hold no stray files."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from pathlib import Path

from tutor.content import units
from tutor.content.cases import cases_of
from tutor.content.model import Course, Lesson
from tutor.content.places import find_line, find_word
from tutor.content.problem import Problem
from tutor.judge.check import Check

_PACKAGE = "__init__.py"
_CACHE = "__pycache__"


def find_disagreements(lesson: Lesson, check: Check) -> Iterator[Problem]:
    """Find where a lesson and its check disagree: on the exercise, its criteria, or the files to hand in."""
    lesson_file, check_file = lesson.folder / "lesson.md", lesson.check
    if check.exercise != lesson.id:
        yield Problem(
            check_file, f"it judges {check.exercise}", f"say {lesson.id}", find_word(check_file, check.exercise)
        )
    constants = _string_constants(check_file)
    in_lesson = {criterion.id: criterion.bonus for criterion in lesson.criteria}
    in_check = {criterion.id: criterion.bonus for criterion in check.criteria}
    for name in sorted(in_lesson.keys() - in_check.keys()):
        place, line = constants.get(name, (check_file, find_line(check_file, r"^CHECK\b")))
        yield Problem(
            place, f"the criterion {name} of the lesson is not judged", "add it, or take it out of the lesson", line
        )
    for name in sorted(in_check.keys() - in_lesson.keys()):
        text, hint = f"the criterion {name} is judged, but the lesson does not have it", "add it with text and hint"
        yield Problem(lesson_file, text, hint, find_line(lesson_file, r"^criteria:"))
    for name in sorted(in_lesson.keys() & in_check.keys()):
        if in_lesson[name] != in_check[name]:
            kinds = ("a bonus", "required") if in_lesson[name] else ("required", "a bonus")
            text = f"the criterion {name} is {kinds[0]} here and {kinds[1]} in the check"
            yield Problem(lesson_file, text, "make them agree", find_line(lesson_file, rf"\bid: *{name}\b"))
    if in_lesson.keys() == in_check.keys() and list(in_lesson) != list(in_check):
        yield Problem(
            lesson_file,
            f"the criteria are in another order than in the check, which has {', '.join(in_check)}",
            "use one order",
            find_line(lesson_file, r"^criteria:"),
        )
    cases = cases_of(lesson)
    known = {cases.report, *cases.places} if cases is not None else set()  # what the launch file starts, or reads
    for file in lesson.files:
        name = file.name.partition("/")[0]  # of a path, the package must be named
        if name not in constants and file.name not in known:
            yield Problem(
                check_file, f"the file {file.name} is named nowhere in it", "the names must agree: start this one"
            )


def find_stray_files(course: Course, lessons: Sequence[Lesson]) -> Iterator[Problem]:
    """Find files beside `lessons` and beside their checks that belong to no lesson of the course."""
    for folder in sorted({lesson.folder.parent for lesson in lessons}):
        lesson_folders = {lesson.folder for lesson in course.lessons if lesson.folder.parent == folder}
        yield from _find_strays(folder, {*lesson_folders, folder / "checklist.yaml", folder / units.FILE})
    for folder in sorted(
        {lesson.check.parent if _is_single_module(lesson) else lesson.check.parent.parent for lesson in lessons}
    ):
        checks = {lesson.check for lesson in course.lessons}
        yield from _find_strays(folder, checks | {check.parent for check in checks if check.name == _PACKAGE})


def _is_single_module(lesson: Lesson) -> bool:
    return lesson.check.name != _PACKAGE


def _find_strays(folder: Path, known: set[Path]) -> Iterator[Problem]:
    if not folder.is_dir():
        return
    for path in sorted(folder.iterdir()):
        leftover = path.is_dir() and {inside.name for inside in path.iterdir()} <= {_CACHE}  # of a check that was moved
        if path not in known and path.name not in (_PACKAGE, _CACHE) and not leftover:
            yield Problem(path, "this belongs to no lesson", "remove it, or finish the lesson")


def _string_constants(check: Path) -> dict[str, tuple[Path, int]]:
    """Return all string constants in the sources of a check, each with where it is first."""
    sources = sorted(check.parent.glob("*.py")) if check.name == _PACKAGE else [check]
    found: dict[str, tuple[Path, int]] = {}
    for source in sources:
        for node in ast.walk(ast.parse(source.read_bytes())):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                found.setdefault(node.value, (source, node.lineno))
    return found
