"""Lints the cases of a lesson that hands over a system: each breaks one file, and the skeleton is the first."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.content.cases import FILE, Cases, LessonCase, cases_of, handed_over
from tutor.content.model import Lesson
from tutor.content.places import find_line
from tutor.content.problem import Problem
from tutor.errors import ContentError


def find_case_problems(lesson: Lesson) -> Iterator[Problem]:
    """Find what is wrong with the cases of a lesson; nothing if it has none."""
    source = lesson.folder / FILE
    try:
        cases = cases_of(lesson)
    except ContentError as error:
        yield Problem(source, error.message, line=error.line)
        return
    if cases is None:
        return
    if cases.report not in [file.name for file in lesson.files]:
        yield Problem(source, f"the report {cases.report} is not a file of the lesson", line=1)
        return
    for case in cases.cases:
        for text in _problems(lesson, cases, case):
            yield Problem(source, text, line=find_line(source, rf"id: *{case.id}\b"))


def _problems(lesson: Lesson, cases: Cases, case: LessonCase) -> Iterator[str]:
    try:
        texts = handed_over(lesson, cases, case)
    except ContentError as error:
        yield f"{case.id}: {error.message}"
        return
    except OSError:  # a file is missing, which is told elsewhere
        return
    files = [file for file in lesson.files if file.name != cases.report]
    changed = [file.name for file in files if texts[file.name] != file.solution.read_text(encoding="utf-8")]
    if changed != [case.where]:
        yield f"{case.id} is in {case.where}, and changes {' and '.join(changed) or 'nothing'}"
    if case is cases.cases[0]:
        for file in lesson.files:
            if file.skeleton.read_text(encoding="utf-8") != texts[file.name]:
                yield f"{case.id} is the first case: the skeleton's {file.name} must be the file with its fault"
