"""Proves that lessons and checks agree, and that nothing lies beside them."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from pathlib import Path

from tutor.content.model import Course, Lesson
from tutor.content.problem import Problem
from tutor.judge.check import Check

_PACKAGE = "__init__.py"
_CACHE = "__pycache__"


def find_disagreements(lesson: Lesson, check: Check) -> Iterator[Problem]:
    """Where a lesson and its check disagree: on the exercise, its criteria, or the files to hand in."""
    said, judged = lesson.folder / "lesson.md", lesson.check
    if check.exercise != lesson.id:
        yield Problem(judged, f"it judges {check.exercise}", f"say {lesson.id}")
    in_lesson = {criterion.id: criterion.bonus for criterion in lesson.criteria}
    in_check = {criterion.id: criterion.bonus for criterion in check.criteria}
    for name in sorted(in_lesson.keys() - in_check.keys()):
        yield Problem(
            judged, f"the criterion {name} of the lesson is not judged", "add it, or take it out of the lesson"
        )
    for name in sorted(in_check.keys() - in_lesson.keys()):
        yield Problem(
            said, f"the criterion {name} is judged, but the lesson does not have it", "add it with text and hint"
        )
    for name in sorted(in_lesson.keys() & in_check.keys()):
        if in_lesson[name] != in_check[name]:
            kinds = ("a bonus", "required") if in_lesson[name] else ("required", "a bonus")
            yield Problem(
                said, f"the criterion {name} is {kinds[0]} here and {kinds[1]} in the check", "make them agree"
            )
    if in_lesson.keys() == in_check.keys() and list(in_lesson) != list(in_check):
        yield Problem(
            said,
            f"the criteria are in another order than in the check, which has {', '.join(in_check)}",
            "use one order",
        )
    texts = _texts(judged)
    for file in lesson.files:
        if file.name not in texts:
            yield Problem(
                judged, f"the file {file.name} is named nowhere in it", "the names must agree: start this one"
            )


def find_stray_files(course: Course, lessons: Sequence[Lesson]) -> Iterator[Problem]:
    """What lies in the folders of `lessons`, and of their checks, and belongs to no lesson of the course."""
    for folder in sorted({lesson.folder.parent for lesson in lessons}):
        mine = {lesson.folder for lesson in course.lessons if lesson.folder.parent == folder}
        yield from _strays(folder, {*mine, folder / "checklist.yaml"})
    for folder in sorted(
        {lesson.check.parent if _is_module(lesson) else lesson.check.parent.parent for lesson in lessons}
    ):
        judges = {lesson.check for lesson in course.lessons}
        yield from _strays(folder, judges | {check.parent for check in judges if check.name == _PACKAGE})


def _is_module(lesson: Lesson) -> bool:
    return lesson.check.name != _PACKAGE


def _strays(folder: Path, known: set[Path]) -> Iterator[Problem]:
    if not folder.is_dir():
        return
    for path in sorted(folder.iterdir()):
        if path not in known and path.name not in (_PACKAGE, _CACHE):
            yield Problem(path, "this belongs to no lesson", "remove it, or finish the lesson")


def _texts(check: Path) -> set[str]:
    """All texts that are written in the sources of a check."""
    sources = sorted(check.parent.glob("*.py")) if check.name == _PACKAGE else [check]
    return {
        node.value
        for source in sources
        for node in ast.walk(ast.parse(source.read_bytes()))
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    }
