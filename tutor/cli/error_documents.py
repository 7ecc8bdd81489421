"""What a command that was asked for a document writes when it cannot do its work: a document that says so."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from tutor.cli import context, terminal
from tutor.cli.errors import describe, exit_code
from tutor.errors import SubmissionError, TutorError

if TYPE_CHECKING:
    from tutor.judge.result import Environment, ExerciseResult, Report

SCHEMA = "ros-tutor/error/1"
_COMMANDS = ("check", "checklist", "list")
_REPORT_FORMATS = ("json", "junit", "markdown")


@dataclass(frozen=True, slots=True)
class _Request:
    """What was asked for. `arguments` is None if the command line could not be read."""

    command: str
    format: str
    output: Path | None
    arguments: argparse.Namespace | None


def write_error_document(error: Exception, arguments: argparse.Namespace | None, words: Sequence[str]) -> None:
    """Write the document of a failed `check` to stdout or to `--output`, or that of another command to stdout.

    Nothing is written if the user did not ask for a document. The error itself is told on stderr in any case.
    """
    request = _read_words(words) if arguments is None else _read_arguments(arguments)
    text = _render(error, request)
    if text is None:
        return
    try:
        if request.output is None:
            terminal.out(text)
        else:
            from tutor.workspace import write_atomically

            write_atomically(request.output, text)
    except TutorError:  # what has failed before matters more
        return


def _read_arguments(arguments: argparse.Namespace) -> _Request:
    format, output = getattr(arguments, "format", None), getattr(arguments, "output", None)
    return _Request(arguments.command or "", format or "text", output, arguments)


def _read_words(words: Sequence[str]) -> _Request:
    """Return what a command line asks for that cannot be read as a whole."""

    def value_of(option: str, default: str) -> str:
        joined = (word.partition("=")[2] for word in words if word.startswith(f"{option}="))
        following = (after for word, after in pairwise(words) if word == option)
        return next(joined, next(following, default))

    command = next((word for word in words if word in _COMMANDS), "")
    output = value_of("--output", "")
    return _Request(command, value_of("--format", "text"), Path(output) if output else None, None)


def _render(error: Exception, request: _Request) -> str | None:
    if request.command == "check":
        if request.format in _REPORT_FORMATS or (request.format == "text" and request.output is not None):
            from tutor.report import render

            return render(_report(error, request.arguments), request.format)
        return None
    if request.command not in _COMMANDS or request.format != "json" or request.output is not None:
        return None
    document = {"schema": SCHEMA, "exit_code": exit_code(error), "message": describe(error)}
    return json.dumps(document, ensure_ascii=False, indent=2) + "\n"


def _report(error: Exception, arguments: argparse.Namespace | None) -> Report:
    from tutor.judge.result import Report

    exercises: Sequence[ExerciseResult] = ()
    if arguments is not None and isinstance(error, SubmissionError):
        exercises = _missing_exercises(error, arguments)
    return Report(_environment(), tuple(exercises), 0.0, message=describe(error))


def _missing_exercises(error: SubmissionError, arguments: argparse.Namespace) -> list[ExerciseResult]:
    """Return a result for each exercise that was to be judged: none of them has all its files."""
    from tutor.cli.choosing import choose_lessons, only_criteria
    from tutor.judge.verdict import Status
    from tutor.workspace import find_submission, look_up, missing_result

    workspace = context.choose_any_workspace(arguments)
    results = []
    for lesson in choose_lessons(arguments.exercise, arguments.criterion, context.load_course(arguments)):
        why = describe(error)
        try:
            find_submission(lesson, arguments.path, workspace)
        except SubmissionError as missing:
            why = describe(missing)
        lookup = look_up(lesson, arguments.path, workspace)
        results.append(only_criteria(missing_result(lesson, Status.ERROR, why, lookup), arguments.criterion))
    return results


def _environment() -> Environment:
    from tutor.ros.environment import detect

    return detect().for_report()
