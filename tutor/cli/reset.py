"""`ros-tutor reset`: restore the skeleton, and keep the learner's file beside it."""

from __future__ import annotations

import argparse
import sys

from tutor.cli import context, terminal
from tutor.cli.errors import PASSED
from tutor.errors import UsageError
from tutor.invocation import command


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `EXERCISE [--yes]`."""
    parser.add_argument("exercise", metavar="EXERCISE", help="for example i2.1")
    parser.add_argument("--yes", action="store_true", help="do not ask for confirmation")


def run(arguments: argparse.Namespace) -> int:
    """Ask for confirmation, then replace the exercise's files with the skeletons."""
    from tutor.workspace import is_started, start

    lesson = context.load_course(arguments).find(arguments.exercise)
    workspace = context.require_workspace(arguments)
    if not workspace.exists or not is_started(lesson, None, workspace):
        raise UsageError(f"{lesson.id} is not started yet; `{command('start', lesson.id)}` puts the skeleton in place")
    names = " and ".join(file.name for file in lesson.files)
    if not arguments.yes and not _confirm(f"Replace your {names} with the skeleton? A backup is kept. [y/N] "):
        terminal.out("Nothing was changed.\n")
        return PASSED
    files = start(lesson, workspace, force=True).files
    lines = [f"  restored   {context.display_path(path)}" for path in files.written]
    lines += [f"  unchanged  {context.display_path(path)}" for path in files.already_there]
    lines += [f"  backup     {context.display_path(path)}" for path in files.backups]
    terminal.out("\n".join([*lines, f"Then: {command('check', lesson.id)}"]) + "\n")
    return PASSED


def _confirm(question: str) -> bool:
    if not terminal.is_terminal(sys.stdin):
        raise UsageError("stdin is no terminal, so nobody can confirm this; pass --yes if you are sure")
    sys.stderr.write(question)
    sys.stderr.flush()
    return sys.stdin.readline().strip().lower() in ("y", "yes")
