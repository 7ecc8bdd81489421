"""Lints test submissions: each declares its expected verdict, and every criterion is met by one and broken by one."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path

from tutor.content.model import Course, Lesson
from tutor.content.patches import patched
from tutor.content.places import find_word
from tutor.content.problem import Problem
from tutor.content.submissions import EXPECT, PATCH, RIGHT, WRONG, Case, read_case
from tutor.errors import ContentError
from tutor.invocation import command

_EXCLUSIVE = ("fails", "bonus_failed")
"""Keys whose criteria may be named in no other key: they fail, so no other expectation can hold for them."""


def find_bad_submissions(
    root: Path, course: Course, lessons: Sequence[Lesson], mistakes: Collection[str] = ()
) -> Iterator[Problem]:
    """Find wrong and missing submissions to `lessons` below the folder `root`.

    `mistakes`: the ids of those that have a page; if none are given, no name is looked up.
    """
    folders = {lesson.folder.name: lesson for lesson in course.lessons}
    for path in _list_entries(root):
        if path.name not in folders and path.name != "README.md":
            yield Problem(path, "this belongs to no exercise", "name the folder after one, as in i1_1")
    for lesson in lessons:
        cases: list[Case] = []
        for found in _find_cases(root / lesson.folder.name, lesson):
            if isinstance(found, Problem):
                yield found
            else:
                cases.append(found)
                yield from _lint_case(found, lesson)
                yield from _find_unknown_mistakes(found, mistakes) if mistakes else ()
        yield from _find_uncovered(root / lesson.folder.name, lesson, cases)


def find_cases(root: Path, lesson: Lesson) -> list[Case]:
    """Return the submissions to a lesson below `root`, without those that cannot be judged as they are."""
    cases = [case for case in _find_cases(root / lesson.folder.name, lesson) if isinstance(case, Case)]
    return [case for case in cases if not list(_lint_case(case, lesson))]


def _find_cases(folder: Path, lesson: Lesson) -> Iterator[Problem | Case]:
    for kind in _list_entries(folder):
        if kind.name not in (RIGHT, WRONG) or not kind.is_dir():
            yield Problem(kind, "this is not a submission", f"put it into {RIGHT}/<name> or {WRONG}/<name>")
            continue
        for path in _list_entries(kind):
            if not path.is_dir() and path.suffix != PATCH:
                yield Problem(
                    path, "this is not a submission", "put it into a folder of its own, or make it a patch (.yaml)"
                )
            elif path.is_dir() and not (path / EXPECT).is_file():
                yield Problem(path, f"there is no {EXPECT}", "say what it must be judged as")
            else:
                try:
                    yield read_case(path)
                except ContentError as error:
                    yield Problem.of(error)


def _lint_case(case: Case, lesson: Lesson) -> Iterator[Problem]:
    if case.changes:
        try:
            patched(lesson, case.changes)
        except ContentError as error:
            yield Problem.of(error)
    for file in lesson.files if not case.changes else ():
        if file.required and not (case.folder / file.name).is_file():
            yield Problem(case.folder, f"there is no {file.name}", "without it there is nothing to judge")
    expected, source = case.expected, case.source
    bonus = {criterion.id: criterion.bonus for criterion in lesson.criteria}
    named = {key: tuple(name for name in texts if name) for key, texts in expected.diagnoses.items()}
    for key, names in {**expected.named, **named}.items():
        for name in names:
            if name not in bonus:
                text, hint = f"{key}: there is no criterion {name!r}", f"the criteria are {', '.join(bonus)}"
                yield Problem(source, text, hint, line=find_word(source, name))
    yield from _find_contradictions(source, expected.named, bonus)
    yield from (Problem(source, text, hint) for text, hint in _lint_kind(case, bonus))


def _find_unknown_mistakes(case: Case, known: Collection[str]) -> Iterator[Problem]:
    from tutor.mistakes.pages import nearest  # late, as the catalogue

    for name in dict.fromkeys(name for names in case.expected.mistakes.values() for name in names):
        if name not in known:
            near = nearest(name, known)
            hint = f"did you mean {' or '.join(near)}?" if near else f"`{command('explain')}` lists all"
            yield Problem(case.source, f"mistake: there is no {name!r}", hint, line=find_word(case.source, name))


def _find_contradictions(
    source: Path, named: Mapping[str, Collection[str]], bonus: Mapping[str, bool]
) -> Iterator[Problem]:
    for name in named["fails"]:
        if bonus.get(name, False):
            yield Problem(source, f"fails: {name} is a bonus", "name it in bonus_failed", line=find_word(source, name))
    for name in named["bonus_failed"]:
        if not bonus.get(name, True):
            yield Problem(
                source, f"bonus_failed: {name} is not a bonus", "name it in fails", line=find_word(source, name)
            )
    for key in _EXCLUSIVE:
        others = {name for other, names in named.items() if other != key for name in names}
        for name in named[key]:
            if name in others:
                yield Problem(
                    source, f"{name} is in {key} and in another key", "name it once", line=find_word(source, name)
                )


def _lint_kind(case: Case, bonus: Mapping[str, bool]) -> Iterator[tuple[str, str]]:
    expected = case.expected
    fails = (*expected.fails, *expected.fails_any)
    if case.kind == RIGHT:
        if not expected.passes:
            yield "a right submission must pass", "write passes: all"
        for name in (*fails, *expected.not_passed, *expected.either):
            if not bonus.get(name, True):
                yield f"{name} does not have to pass, but this is a right submission", f"move it to {WRONG}"
    else:
        if expected.passes:
            yield "a wrong submission must not pass", f"take out passes, or move it to {RIGHT}"
        if not fails and not expected.bonus_failed:
            yield "nothing fails, but this is a wrong submission", "name what it breaks in fails"


def _find_uncovered(folder: Path, lesson: Lesson, cases: Sequence[Case]) -> Iterator[Problem]:
    for criterion in lesson.criteria:
        key = "bonus_failed" if criterion.bonus else "fails"
        if not any(criterion.id in case.expected.named[key] for case in cases):
            yield Problem(
                folder / WRONG, f"no submission breaks {criterion.id}", f"add one with {key}: [{criterion.id}]"
            )
        if not any(_meets(case, criterion.id) for case in cases):
            yield Problem(folder / RIGHT, f"no submission keeps {criterion.id}", "add one that passes it for certain")


def _meets(case: Case, criterion: str) -> bool:
    return case.kind == RIGHT and not any(criterion in names for names in case.expected.named.values())


def _list_entries(folder: Path) -> list[Path]:
    if not folder.is_dir():
        return []
    return sorted(path for path in folder.iterdir() if path.name != "__pycache__")
