"""`ros-tutor watch`: check again after each save."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING

from tutor.cli import check, context, terminal
from tutor.cli.errors import INTERRUPTED

if TYPE_CHECKING:
    from tutor.cli.interruptible_run import Engine

_POLL_INTERVAL_S = 0.3
_SOURCE_SUFFIXES = (".py", ".xml", ".yaml", ".yml")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `EXERCISE [PATH] [--criterion ID]... [--first]`."""
    parser.add_argument("exercise", metavar="EXERCISE", help="for example i2.1")
    parser.add_argument("path", metavar="PATH", nargs="?", type=Path, help="a file or folder (or the workspace's own)")
    parser.add_argument("--criterion", metavar="ID", action="append", help="judge only this one (repeatable)")
    check.add_first(parser)
    parser.set_defaults(solution=False, isolate=False, format="text", output=None)


def run(arguments: argparse.Namespace, engine: Engine | None = None) -> int:
    """Check now and after each save, until Ctrl+C.

    Saves of the exercise's own files count, and of other source files beside them that belong to no other exercise.
    """
    from tutor.errors import SubmissionError
    from tutor.workspace import find_submission

    course = context.load_course(arguments)
    lesson = course.find(arguments.exercise)
    submission = find_submission(lesson, arguments.path, context.require_workspace(arguments))
    folders = {path.parent for path in submission.files.values()}
    own = set(submission.files.values())
    others = {file.name for other in course.lessons for file in other.files if other.id != lesson.id}
    while True:
        seen = _read_sources(folders, own, others)
        try:
            if check.run(arguments, engine) == INTERRUPTED:
                return INTERRUPTED
        except SubmissionError as error:  # the file was renamed, or is only half saved
            terminal.say(str(error))
        terminal.say(f"waiting for the next save of {' or '.join(sorted(path.name for path in own))}; Ctrl+C ends it")
        while _read_sources(folders, own, others) == seen:
            time.sleep(_POLL_INTERVAL_S)


def _read_sources(folders: set[Path], own: set[Path], others: set[str]) -> dict[Path, bytes]:
    """Return the contents of the files that a check may read, by path."""
    found: dict[Path, bytes] = {}
    for folder in folders:
        try:
            paths = [path for path in folder.iterdir() if path.suffix in _SOURCE_SUFFIXES and path.name not in others]
        except OSError:
            continue
        for path in {*paths, *(path for path in own if path.parent == folder)}:
            try:
                found[path] = path.read_bytes()
            except OSError:
                continue
    return found
