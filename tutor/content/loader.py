"""Reads a course from disk.

A course is a folder with

- lessons/checklist.yaml: the self-assessment checklist
- lessons/units.yaml: the order of its units (see `units`); not required
- lessons/i1_1/lesson.md: YAML front matter between two --- lines, then the lesson in Markdown
- lessons/i1_1/predictions.yaml: predictions about given programs (see `predictions`); most lessons have none
- lessons/i1_1/skeleton/: the files a learner starts from
- lessons/i1_1/solution/: our solution
- lessons/i1_1/cases.yaml: where a system with a fault is handed over, the faults that are drawn from (see `cases`)
- checks/i1_1.py, or i1_1_ and what it is: the module or package that judges it (not read here)
- course.yaml: its name and title (see `courses`); the bundled course has none
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from tutor.content.cases import FILE as CASES
from tutor.content.courses import MANIFEST, Manifest, read_manifest
from tutor.content.fields import Document, Fields, read_text
from tutor.content.live import LiveTopic, LiveView, Partner
from tutor.content.model import (
    Checklist,
    ChecklistGroup,
    ChecklistItem,
    Course,
    CriterionText,
    Difficulty,
    Lesson,
    LessonFile,
)
from tutor.content.predictions import read_predictions
from tutor.content.units import read_units
from tutor.errors import ContentError

# The folders tutor, lessons and checks are siblings, both in the repository and in an installed wheel. Importing
# `lessons` to locate it could find a folder of that name in a learner's PYTHONPATH instead.
BUNDLED = Path(__file__).resolve().parents[2]

BUNDLED_TITLE = "ROS 2, intermediate"

_FENCE = "---"
_LESSON_FOLDER = re.compile(r"[a-z]+[0-9]+_[0-9]+")


def load_course(extra: Path | Sequence[Path] | None = None, *, only: bool = False) -> Course:
    """Read the bundled course, followed by those in `extra`, folders with `lessons/` and `checks/`; or `only` these.

    Raises ContentError for the first problem.
    """
    folders = [] if extra is None else [extra] if isinstance(extra, Path) else list(extra)
    course = Course((), Checklist()) if only and folders else _read_course(BUNDLED / "lessons")
    for folder in folders:
        course = _joined(course, _read_course(folder / "lessons"), read_manifest(folder))
    return course


def _joined(course: Course, more: Course, manifest: Manifest) -> Course:
    known = {lesson.id for lesson in course.lessons}
    lessons = [replace(lesson, course=manifest.name, heading=manifest.title) for lesson in more.lessons]
    lessons = [
        replace(lesson, id=f"{manifest.name}:{lesson.id}") if lesson.id in known else lesson for lesson in lessons
    ]
    for lesson in lessons:
        if lesson.id in known:
            text = f"there is a course named {manifest.name} already, with an exercise {lesson.own_id}"
            raise ContentError(lesson.folder.parents[1] / MANIFEST, text, field="name")
    return Course(
        lessons=(*course.lessons, *lessons),
        checklist=replace(course.checklist, groups=course.checklist.groups + more.checklist.groups),
    )


def _read_course(lessons: Path) -> Course:
    if not lessons.is_dir():
        raise ContentError(lessons, "there is no such folder")
    folders = [folder for folder in lessons.iterdir() if _LESSON_FOLDER.fullmatch(folder.name) and folder.is_dir()]
    checklist, units = lessons / "checklist.yaml", read_units(lessons)
    found = [replace(_read_lesson(folder), beyond=units.is_beyond(folder)) for folder in sorted(folders, key=units.key)]
    return Course(
        lessons=tuple(found),
        checklist=_read_checklist(checklist) if checklist.exists() else Checklist(),
    )


def _read_lesson(folder: Path) -> Lesson:
    file = folder / "lesson.md"
    head, fence, body = _split_front_matter(read_text(file))
    if not fence:
        raise ContentError(file, f"expected a front matter between two {_FENCE} lines at the top", line=1)
    fields = Document(file, head, offset=1).read()
    lesson = Lesson(
        id=_read_id(fields, folder),
        title=fields.text("title"),
        difficulty=_read_difficulty(fields),
        unit=fields.text("unit"),
        objective=fields.text("objective"),
        files=tuple(_read_file(item, folder) for item in fields.mappings("files")),
        criteria=tuple(_read_criterion(item) for item in fields.mappings("criteria")),
        hints=fields.texts("hints"),
        checklist=fields.texts("checklist", optional=True),
        body=body.strip("\n") + "\n",
        folder=folder,
        heading=BUNDLED_TITLE,
        live=_read_live(fields.mapping("live"), folder),
        predictions=read_predictions(folder),
    )
    fields.done()
    return lesson


def _split_front_matter(text: str) -> tuple[str, str, str]:
    """Split a lesson into its front matter, the closing fence (empty if there is none), and the body."""
    opening, _, rest = text.partition("\n")
    if opening.rstrip() != _FENCE:
        return "", "", ""
    return rest.partition(f"\n{_FENCE}\n")


def _read_id(fields: Fields, folder: Path) -> str:
    found = fields.text("id")
    if found != folder.name.replace("_", "."):
        raise fields.error("id", f"{found!r} does not belong in the folder {folder.name}")
    return found


def _read_difficulty(fields: Fields) -> Difficulty:
    found = fields.text("difficulty")
    try:
        return Difficulty(found)
    except ValueError:
        raise fields.error("difficulty", f"{found!r} is not one of {', '.join(Difficulty)}") from None


def _read_file(fields: Fields, folder: Path) -> LessonFile:
    name = fields.text("name")
    if any(part in ("", "..") or part.startswith(".") for part in name.split("/")):
        raise fields.error("name", f"expected a file name, found {name!r}")
    required = fields.flag("required", True)
    fields.done()
    skeleton, solution = folder / "skeleton" / name, folder / "solution" / name
    if (folder / CASES).is_file() and not skeleton.is_file():
        skeleton = solution  # this one is handed over as it is
    return LessonFile(name, required, skeleton, solution)


def _read_criterion(fields: Fields) -> CriterionText:
    shows, calls = fields.texts("shows", optional=True), fields.mapping("calls")
    methods = {item: calls.text(item, optional=True) for item in shows} if calls is not None else {}
    if calls is not None:
        calls.done()
    criterion = CriterionText(
        id=fields.text("id"),
        text=fields.text("text"),
        bonus=fields.flag("bonus", False),
        open=fields.flag("open", True),
        hint=fields.text("hint"),
        shows=shows,
        given=fields.text("given", optional=True),
        calls=tuple((item, method) for item, method in methods.items() if method),
    )
    fields.done()
    return criterion


def _read_live(fields: Fields | None, folder: Path) -> LiveView:
    if fields is None:
        return LiveView()
    found = LiveView(
        topics=tuple(_read_topic(item) for item in fields.mappings("topics", optional=True)),
        services=fields.texts("services", optional=True),
        partners=tuple(_read_partner(item, folder) for item in fields.mappings("partners", optional=True)),
        has_hidden_fault=(folder / CASES).is_file(),
    )
    fields.done()
    return found


def _read_topic(fields: Fields) -> LiveTopic:
    low, high = fields.number("low"), fields.number("high")
    if (low is None) is not (high is None) or (low is not None and high is not None and low >= high):
        raise fields.error("low", "a band goes from a `low` to a greater `high`")
    band = None if low is None or high is None else (low, high)
    topic = LiveTopic(fields.text("name"), fields.text("type"), band)
    fields.done()
    return topic


def _read_partner(fields: Fields, folder: Path) -> Partner:
    run, file = fields.text("run", optional=True), fields.text("file", optional=True)
    if bool(run) is bool(file):
        raise fields.error("run", "a partner has either `run` or `file`")
    partner = Partner(
        name=fields.text("name"),
        does=fields.text("does"),
        run=tuple(run.split()),
        file=folder / file if file else None,
        beside=fields.text("beside", optional=True),
    )
    fields.done()
    return partner


def _read_checklist(file: Path) -> Checklist:
    fields = Document.of(file).read()
    checklist = Checklist(
        groups=tuple(_read_group(group) for group in fields.mappings("groups")),
        ready_title=fields.text("ready_title", optional=True),
        ready_text=fields.text("ready_text", optional=True),
    )
    fields.done()
    return checklist


def _read_group(fields: Fields) -> ChecklistGroup:
    group = ChecklistGroup(
        id=fields.text("id"),
        title=fields.text("title"),
        items=tuple(_read_item(item) for item in fields.mappings("items")),
    )
    fields.done()
    return group


def _read_item(fields: Fields) -> ChecklistItem:
    item = ChecklistItem(id=fields.text("id"), text=fields.text("text"))
    fields.done()
    return item
