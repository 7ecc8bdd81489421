"""The learner's answer in an exercise that hands over a system: what is wrong, and where."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tutor.content import Lesson
from tutor.content.cases import Cases, Report, cases_of, read_report, with_answer, with_case
from tutor.errors import StorageError, UsageError
from tutor.invocation import command
from tutor.workspace.layout import Workspace
from tutor.workspace.saving import overwrite_file, read_source


@dataclass(frozen=True, slots=True)
class Question:
    """What an answer chooses from, and what it was. `path`: the report, with this `text`."""

    cases: Cases
    path: Path
    text: str

    @property
    def report(self) -> Report:
        """What the report says."""
        return read_report(self.text)


def ask(lesson: Lesson, workspace: Workspace) -> Question:
    """Read the choices and the report of a lesson. Raises UsageError if it asks for none, and StorageError."""
    cases = cases_of(lesson)
    if cases is None:
        raise UsageError(f"{lesson.id} has nothing to answer: it is judged by what your nodes do")
    path = workspace.path_of(cases.report)
    text = read_source(path)
    if text is None:
        raise UsageError(f"{lesson.id} is not started yet; `{command('start', lesson.id)}` hands the system over")
    return Question(cases, path, text)


def answer(lesson: Lesson, workspace: Workspace, what: str, where: str) -> Report:
    """Write an answer into the report, and return it. The same one again is no further try.

    Raises UsageError for what is not among the choices, and StorageError.
    """
    question = ask(lesson, workspace)
    cases, report = question.cases, question.report
    for value, choices in ((what, tuple(cases.kinds)), (where, cases.places)):
        if value not in choices:
            raise UsageError(f"{value!r} is none of the choices: {', '.join(choices)}")
    tries = report.tries + ((what, where) != (report.what, report.where))
    text = with_answer(question.text, what, where, tries)
    if not read_report(text).case:
        drawn = workspace.cases().read(lesson.id).current
        text = with_case(text, drawn) if "case:" in text else f"case: {drawn}\n{text}"
    if not overwrite_file(question.path, text, question.text).done:
        raise StorageError(f"{question.path} was changed meanwhile: answer again")
    return read_report(text)
