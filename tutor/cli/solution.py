"""`ros-tutor solution`: print our solution."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from tutor.cli import context, terminal
from tutor.cli.errors import PASSED

if TYPE_CHECKING:
    from tutor.workspace import Workspace


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `EXERCISE`."""
    parser.add_argument("exercise", metavar="EXERCISE", help="for example i2.1")


def run(arguments: argparse.Namespace) -> int:
    """Print the files; if there are several, each below a comment with its name."""
    from tutor.workspace.drawn_cases import solution_text

    lesson = context.load_course(arguments).find(arguments.exercise)
    workspace = context.require_workspace(arguments)
    drawn = workspace.cases(terminal.say).read(lesson.id)
    texts = []
    for file in lesson.files:
        text = solution_text(lesson, file, drawn).rstrip("\n") + "\n"
        texts.append(f"# --- {file.name} ---\n{text}" if len(lesson.files) > 1 else text)
    note_shown(workspace, lesson.id)
    terminal.out("\n\n".join(texts))
    return PASSED


def note_shown(workspace: Workspace, exercise: str) -> None:
    """Note in the progress, if there is any, that our solution was shown. A failure to save only prints a line."""
    from tutor.errors import StorageError

    if not workspace.exists:
        return
    try:
        workspace.progress(terminal.say).change(lambda progress: progress.with_solution(exercise))
    except StorageError as error:
        terminal.say(f"that you have seen it is not in your progress: {error}")
