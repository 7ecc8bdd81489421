"""`ros-tutor check`: judge exercises without the app."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from tutor.cli import context, terminal
from tutor.cli.errors import FAULT, INTERRUPTED, NOT_PASSED, PASSED
from tutor.errors import UsageError

if TYPE_CHECKING:
    from tutor.cli.interruptible_run import Engine
    from tutor.content import Course
    from tutor.judge.result import ExerciseResult, Report
    from tutor.judge.submission import Submission
    from tutor.workspace import Workspace

_CODES = {"passed": PASSED, "failed": NOT_PASSED, "error": FAULT}
_FORMATS = ("text", "json", "junit", "markdown")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `EXERCISE [PATH] [--solution] [--criterion ID]... [--first] [--isolate] [--format F] [--output FILE]`."""
    parser.add_argument("exercise", metavar="EXERCISE", help="for example i2.1; or all, which judges them in parallel")
    parser.add_argument("path", metavar="PATH", nargs="?", type=Path, help="a file or folder (or the workspace's own)")
    parser.add_argument("--solution", action="store_true", help="judge our own solution instead")
    parser.add_argument("--criterion", metavar="ID", action="append", help="judge only this one (repeatable)")
    add_first(parser)
    parser.add_argument(
        "--isolate",
        action="store_true",
        help="shut the submission off from files, processes and the network (needs bubblewrap)",
    )
    parser.add_argument("--format", choices=_FORMATS, default="text", help="text (default), json, junit or markdown")
    parser.add_argument("--output", metavar="FILE", type=Path, help="write the report there instead of to stdout")


def add_first(parser: argparse.ArgumentParser) -> None:
    """Add `--first`, which ends a check at its first failure."""
    parser.add_argument("--first", action="store_true", help="end the check at the first criterion that fails")


def run(arguments: argparse.Namespace, engine: Engine | None = None) -> int:
    """Judge, write the report, and save the result if the workspace's own files were judged."""
    from tutor.cli.choosing import ALL, choose_lessons, choose_submissions, with_missing
    from tutor.cli.interruptible_run import display_for, judge
    from tutor.report import renderer_of
    from tutor.workspace import find_submission, solution

    _check_options(arguments)
    if engine is None:
        engine = _make_engine(isolate=arguments.isolate, first=arguments.first)
    course = context.load_course(arguments)
    workspace = context.require_workspace(arguments)
    lessons = choose_lessons(arguments.exercise, arguments.criterion, course)
    missing: Sequence[ExerciseResult] = ()
    if arguments.solution:
        submissions = [solution(lesson) for lesson in lessons]
    elif arguments.exercise.lower() == ALL:
        submissions, missing = choose_submissions(lessons, arguments.path, workspace)
    else:
        submissions = [find_submission(lessons[0], arguments.path, workspace)]

    only = frozenset(arguments.criterion) if arguments.criterion else None
    to_terminal = arguments.output is None and terminal.is_terminal(sys.stdout)
    renderer_of(arguments.format)  # import it before a learner's program runs, which might overwrite our modules
    report = judge(engine, submissions, course, only, display_for(course, report_follows=to_terminal))
    if report is None:
        terminal.say("interrupted; nothing is left running")
        return INTERRUPTED
    if not arguments.solution:
        _record(
            report, submissions, course, workspace
        )  # before _write_report: the result survives an unwritable report
    report = with_missing(report, missing, lessons, only)
    _write_report(report, arguments)
    return _CODES[report.verdict.value]


def _make_engine(*, isolate: bool, first: bool) -> Engine:
    from tutor.engine import run_check  # imported late: only a check needs ROS

    if not isolate:
        return partial(run_check, first=True) if first else run_check
    from tutor.engine.isolation import Isolation

    isolation = Isolation.set_up()  # before anything else: this process must still be single-threaded
    return partial(run_check, isolation=isolation, first=first)


def _check_options(arguments: argparse.Namespace) -> None:
    path, output = arguments.path, arguments.output
    if arguments.solution and path is not None:
        raise UsageError("--solution judges our own files: give no PATH with it")
    if path is not None and arguments.exercise.lower() == "all" and not path.is_dir():
        raise UsageError(f"check all needs a folder, and {path} is not one")
    if output is not None and not output.absolute().parent.is_dir():
        raise UsageError(f"--output {output}: there is no folder {output.parent}")
    if output is not None and output.is_dir():
        raise UsageError(f"--output {output}: this is a folder, not a file")


def _write_report(report: Report, arguments: argparse.Namespace) -> None:
    from tutor.report import render
    from tutor.workspace import write_atomically

    if arguments.output is not None:
        write_atomically(arguments.output, render(report, arguments.format))
        terminal.say(f"{report.verdict.value}; the report is in {arguments.output}")
    else:
        color, width = terminal.wants_color(sys.stdout), terminal.width(sys.stdout)
        terminal.out(render(report, arguments.format, color=color, width=width))


def _record(report: Report, submissions: Sequence[Submission], course: Course, workspace: Workspace) -> None:
    """Save attempts on the workspace's own files. A failure to save does not change the verdict."""
    from tutor.errors import StorageError
    from tutor.workspace import is_own, record

    own = {submission.exercise for submission in submissions if is_own(submission, workspace)}
    results = [result for result in report.exercises if result.id in own]
    if not results:
        return

    criteria = {result.id: [criterion.id for criterion in course.find(result.id).criteria] for result in results}
    try:
        record(results, workspace, criteria, terminal.say)
    except StorageError as error:
        terminal.say(f"this check is not in your progress: {error}")
