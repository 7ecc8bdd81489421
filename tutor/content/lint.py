"""Lints a loaded course: finds mistakes that the loader cannot see and that a learner would stumble over."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from tutor.content.cases import FILE as CASES
from tutor.content.lint_cases import find_case_problems
from tutor.content.lint_predictions import find_bad_predictions
from tutor.content.model import Course, CriterionText, Lesson
from tutor.content.places import find_line
from tutor.content.predictions import FILE as PREDICTIONS
from tutor.content.problem import Problem

SECTIONS = (
    "Objective",
    "Background",
    "Tasks",
    "Commands to try",
    "Pitfalls on Jazzy",
    "What the checks look at",
)
"""The second-level headings of every lesson, in this order."""

HINTS = 3

CODE_WIDTH = 76
"""The longest line of code that the app shows without wrapping on an 80-column terminal."""

_CRITERION_ID = re.compile(r"[a-z-]+")
_CHECKLIST_ID = re.compile(r"[a-z][a-z0-9-]*")
_CODE_FENCE = re.compile(r"\s*```(.*)")
_RAW_HTML = re.compile(r"</?[a-zA-Z][^>]*>|<!--")


def lint_course(course: Course) -> list[Problem]:
    """Return all problems of a course, lesson by lesson; empty if there are none."""
    problems = list(_lint_ids_and_groups(course))
    for lesson in course.lessons:
        source = lesson.folder / "lesson.md"
        for key, text in _lint_front_matter(lesson, course):
            problems.append(Problem(source, text, line=find_line(source, key)))
        first = _first_line_of_body(source, lesson.body)
        problems += [Problem(source, text, line=first + line) for line, text in _lint_body(lesson.body)]
        problems += [*_lint_folder(lesson), *find_case_problems(lesson)]
        problems += find_bad_predictions(lesson, [item.id for item in course.checklist.items])
    return problems


def _lint_ids_and_groups(course: Course) -> Iterator[Problem]:
    for lesson_id in _duplicates(lesson.id for lesson in course.lessons):
        folder = course.find(lesson_id).folder
        yield Problem(folder / "lesson.md", f"the exercise id {lesson_id} is used twice")
    checklist = _checklist_file(course)
    groups = course.checklist.groups
    ids = [group.id for group in groups] + [item.id for item in course.checklist.items]
    for item_id in _duplicates(ids):
        yield Problem(checklist, f"the id {item_id} is used twice")
    for item_id in ids:
        if not _CHECKLIST_ID.fullmatch(item_id):
            yield Problem(checklist, f"the id {item_id!r} is not in kebab-case")
    for group in groups:
        if not group.items:
            yield Problem(checklist, f"the group {group.id} has no items")


def _checklist_file(course: Course) -> Path:
    folder = course.lessons[0].folder.parent if course.lessons else Path()
    return folder / "checklist.yaml"


def _lint_front_matter(lesson: Lesson, course: Course) -> Iterator[tuple[str, str]]:
    """Yield each problem after a pattern for its line."""
    if not any(file.required for file in lesson.files):
        yield "^files:", "it requires no file"
    for name in _duplicates(file.name for file in lesson.files):
        yield rf"name: {re.escape(name)}", f"the file {name} is named twice"
    yield from _lint_criteria(lesson.criteria)
    if len(lesson.hints) != HINTS:
        yield "^hints:", f"it has {len(lesson.hints)} hints instead of {HINTS}"
    for hint in _duplicates(lesson.hints):
        yield re.escape(hint), f"the hint {hint!r} appears twice"
    known = {item.id for item in course.checklist.items}
    for item in lesson.checklist:
        if item not in known:
            yield "^checklist:", f"the checklist has no item {item!r}"
    for item in _duplicates(lesson.checklist):
        yield "^checklist:", f"the checklist item {item} is named twice"
    for criterion in lesson.criteria:
        place = _place_of(criterion)
        for item in criterion.shows:
            if item not in lesson.checklist:
                yield place, f"the criterion {criterion.id} shows {item!r}, which is not in the lesson's checklist"
        yield from ((place, text) for text in _lint_given(lesson, criterion))


def _place_of(criterion: CriterionText) -> str:
    return rf"\bid: *{re.escape(criterion.id)}\s*(?:$|,)"


def _lint_given(lesson: Lesson, criterion: CriterionText) -> Iterator[str]:
    if criterion.open and criterion.given:
        yield f"the criterion {criterion.id} is open: its `given` names code that does not meet it"
    elif criterion.given and not re.search(
        rf"^\s*(async )?def {re.escape(criterion.given)}\(", _skeleton(lesson), re.M
    ):
        yield f"the skeleton has no function {criterion.given}, which is `given` for the criterion {criterion.id}"
    elif criterion.shows and not criterion.open and not criterion.given:
        yield f"the skeleton meets {criterion.id}, which shows nothing then: name the function that does with `given`"


def _skeleton(lesson: Lesson) -> str:
    if not lesson.files:
        return ""
    try:
        return lesson.files[0].skeleton.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return ""


def _lint_criteria(criteria: Sequence[CriterionText]) -> Iterator[tuple[str, str]]:
    required = [criterion for criterion in criteria if not criterion.bonus]
    if not required:
        yield "^criteria:", "it has no criterion that is required"
    elif not any(criterion.open for criterion in required):
        yield "^criteria:", "the skeleton leaves no required criterion open: there is nothing to do"
    if list(criteria[: len(required)]) != required:
        yield "^criteria:", "its required criteria belong before the bonus ones"
    for criterion_id in _duplicates(criterion.id for criterion in criteria):
        yield rf"id: *{re.escape(criterion_id)}", f"the criterion {criterion_id} appears twice"
    for criterion in criteria:
        if not _CRITERION_ID.fullmatch(criterion.id):
            text = f"the criterion id {criterion.id!r} may only have lowercase letters and hyphens"
            yield _place_of(criterion), text
        for name, value in (("text", criterion.text), ("hint", criterion.hint)):
            if not value:
                yield _place_of(criterion), f"the criterion {criterion.id} has no {name}"


def _first_line_of_body(source: Path, body: str) -> int:
    """Return the number of the line of the file with which the body begins."""
    text = source.read_text(encoding="utf-8")
    return text.count("\n", 0, max(text.rfind(body.rstrip("\n")), 0)) + 1


def _lint_body(body: str) -> Iterator[tuple[int, str]]:
    """Yield each problem after the number of its line, from 0."""
    headings = []
    opened = 0
    fenced = False
    for number, line in enumerate(body.splitlines()):
        fence = _CODE_FENCE.fullmatch(line)
        if fence:
            fenced, opened = not fenced, number
        if line.startswith("## ") and not fenced:
            headings.append(line.removeprefix("## ").strip())
        yield from ((number, text) for text in _lint_line(line, fence, fenced))
    if fenced:
        yield opened, "a code block is never closed"
    if tuple(headings) != SECTIONS:
        yield 0, f"its sections are {', '.join(headings) or 'missing'}; expected {', '.join(SECTIONS)}"


def _lint_line(line: str, fence: re.Match[str] | None, fenced: bool) -> Iterator[str]:
    if "\t" in line:
        yield f"there is a tab in {line.strip()!r}"
    if fence:
        if fenced and not fence[1].strip():
            yield "a code block does not say its language"
    elif fenced:
        if len(line) > CODE_WIDTH:
            yield f"the code {line.strip()!r} is wider than {CODE_WIDTH} characters"
    elif line.startswith("# "):
        yield f"the heading {line!r} is a title: the title is in the front matter"
    elif line.startswith("## "):
        return
    elif line.count("`") % 2:
        yield f"the code in {line.strip()!r} is broken over two lines"
    elif _RAW_HTML.search(re.sub(r"`[^`]*`", "", line)):
        yield f"there is raw HTML in {line.strip()!r}, which a terminal cannot show"


def _lint_folder(lesson: Lesson) -> Iterator[Problem]:
    expected = {lesson.folder / "lesson.md", lesson.folder / CASES}
    for file in lesson.files:
        expected |= {file.skeleton, file.solution}
        both = (file.skeleton, file.solution)
        for path in both:
            if not path.is_file():
                yield Problem(path, "this file is missing")
            else:
                yield from _lint_source(path)
        if "/" in file.name:
            continue  # a file of a package of its own may be given, such as its package.xml
        given = file.skeleton == file.solution
        if not given and file.skeleton.is_file() and file.solution.is_file() and _same_content(*both):
            yield Problem(file.skeleton, "the skeleton is the solution")
    for partner in lesson.live.partners:
        if partner.beside and partner.beside not in [file.name for file in lesson.files]:
            yield Problem(
                lesson.folder / "lesson.md",
                f"{partner.name} is beside {partner.beside}, which is not a file of the lesson",
            )
        if partner.file is not None:
            expected.add(partner.file)
            if not partner.file.is_file():
                yield Problem(partner.file, "this file is missing")
            else:
                yield from _lint_source(partner.file)
    if lesson.predictions:
        expected.add(lesson.folder / PREDICTIONS)
    for program in dict.fromkeys(prediction.program for prediction in lesson.predictions):
        expected.add(program)
        if not program.is_file():
            yield Problem(program, "this file is missing")
        else:
            yield from _lint_source(program)
    for path in sorted(lesson.folder.rglob("*")):
        if path.is_file() and path not in expected and path.parent.name != "__pycache__":
            yield Problem(path, "this file belongs to no lesson")


def _lint_source(path: Path) -> Iterator[Problem]:
    source = path.read_bytes()
    if b"\t" in source:
        yield Problem(path, "there is a tab in it")
    if path.suffix == ".py":
        try:
            compile(source, path, "exec", dont_inherit=True)
        except (SyntaxError, ValueError) as error:
            yield Problem(path, f"it does not compile: {error}", line=getattr(error, "lineno", None))


def _same_content(one: Path, other: Path) -> bool:
    return one.read_bytes() == other.read_bytes()


def _duplicates(values: Iterable[str]) -> list[str]:
    return [value for value, count in Counter(values).items() if count > 1]
