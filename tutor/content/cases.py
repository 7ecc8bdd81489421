"""The cases of an exercise that hands over a system with a fault: one of them is drawn for each learner.

They are in the lesson's folder, in `cases.yaml` (see `tutor.exercise.faults`, which reads what a check needs of it). A
case is put into the solution as a test submission's patch is. The lesson's skeleton is the first case.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import yaml

from tutor.content.fields import Document, Fields
from tutor.content.model import Lesson, LessonFile
from tutor.content.patches import Change, patched, read_changes
from tutor.errors import ContentError

FILE = "cases.yaml"

_CASE_LINE = re.compile(r"^case:.*$", re.M)


@dataclass(frozen=True, slots=True)
class LessonCase:
    """One fault. `id` says nothing to the learner. `what`: the kinds that name it; `where`: the file that it is in."""

    id: str
    what: tuple[str, ...]
    where: str
    changes: tuple[Change, ...]


@dataclass(frozen=True, slots=True)
class Cases:
    """All cases, the first one being that of the lesson's skeleton.

    `report`: the file in which the learner says what it is, and where. `kinds`: what it can be: by id, in words.
    """

    report: str
    kinds: Mapping[str, str]
    cases: tuple[LessonCase, ...]

    def find(self, id: str) -> LessonCase | None:
        """The case with this id."""
        return next((case for case in self.cases if case.id == id), None)

    @property
    def places(self) -> tuple[str, ...]:
        """The files that a fault may be in, sorted."""
        return tuple(sorted({case.where for case in self.cases}))


@dataclass(frozen=True, slots=True)
class Report:
    """What a learner's report says; "" for what it does not. `tries`: how many answers they have given."""

    case: str = ""
    what: str = ""
    where: str = ""
    tries: int = 0


def has_cases(lesson: Lesson) -> bool:
    """Whether a lesson hands over a system with a fault."""
    return (lesson.folder / FILE).is_file()


def cases_of(lesson: Lesson) -> Cases | None:
    """Read the cases of a lesson; None if it has none. Raises ContentError."""
    file = lesson.folder / FILE
    if not file.is_file():
        return None
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ContentError(file, f"cannot read it: {error}") from error
    fields = Document(file, text).read()
    kinds = fields.anything("kinds")
    if not isinstance(kinds, dict) or not all(isinstance(kind, dict) and kind.get("says") for kind in kinds.values()):
        raise fields.error("kinds", "expected the kinds of faults, each with what it `says` and `shows`")
    cases = Cases(
        fields.text("report"),
        {str(id): str(kind["says"]) for id, kind in kinds.items()},
        tuple(_read_case(item, file) for item in fields.mappings("cases")),
    )
    for case in cases.cases:
        for what in case.what:
            if what not in cases.kinds:
                raise fields.error("cases", f"{case.id}: {what!r} is not among the kinds")
    if len({case.id for case in cases.cases}) < len(cases.cases):
        raise fields.error("cases", "an id is used twice")
    fields.done()
    return cases


def _read_case(fields: Fields, file: Path) -> LessonCase:
    what = fields.anything("what")
    kinds = (what,) if isinstance(what, str) else tuple(what) if isinstance(what, list) else ()
    if not kinds or not all(isinstance(kind, str) for kind in kinds):
        raise fields.error("what", "expected a kind of fault, or a list of those that name it")
    case = LessonCase(fields.text("id"), kinds, fields.text("where"), read_changes(fields, file))
    if not case.changes:
        raise fields.error("change", "this field is missing: say what of the solution becomes what")
    fields.done()
    return case


def handed_over(lesson: Lesson, cases: Cases, case: LessonCase) -> Mapping[str, str]:
    """The files of a lesson with this case, by name, the report without an answer.

    Raises ContentError, and OSError.
    """
    report = next(file.skeleton for file in lesson.files if file.name == cases.report)
    text = with_case(report.read_text(encoding="utf-8"), case.id)
    return {**patched(lesson, case.changes), cases.report: text}


def solution_of(file: LessonFile, cases: Cases, case: LessonCase) -> str:
    """Our solution's file, with this case in the report. Raises OSError."""
    text = file.solution.read_text(encoding="utf-8")
    if file.name != cases.report:
        return text
    return with_answer(with_case(text, case.id), case.what[0], case.where, 1)


def with_case(text: str, case: str) -> str:
    """A report that names this case."""
    return _CASE_LINE.sub(f"case: {case}", text, count=1)


def with_answer(text: str, what: str, where: str, tries: int) -> str:
    """A report with this answer; its comments stay."""
    for key, value in (("what", what), ("where", where), ("tries", str(tries))):
        line = f"{key}: {value}".rstrip()
        text, count = re.subn(rf"^{key}:.*$", line, text, count=1, flags=re.M)
        if not count:
            text = f"{text.rstrip()}\n{line}\n"
    return text


def read_report(text: str) -> Report:
    """What a report says, as far as it can be read."""
    try:
        found = yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, RecursionError):
        found = None
    if not isinstance(found, dict):
        return Report()
    tries = found.get("tries")
    words = (found.get(key) for key in ("case", "what", "where"))
    case, what, where = (word if isinstance(word, str) else "" for word in words)
    return Report(case, what, where, tries if isinstance(tries, int) else 0)
