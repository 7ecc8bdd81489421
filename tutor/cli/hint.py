"""`ros-tutor hint`: the next hint."""

from __future__ import annotations

import argparse
import sys

from tutor.cli import context, terminal
from tutor.cli.errors import PASSED
from tutor.invocation import command


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `EXERCISE [--all]`."""
    parser.add_argument("exercise", metavar="EXERCISE", help="for example i2.1")
    parser.add_argument("--all", action="store_true", help="show all hints at once")


def run(arguments: argparse.Namespace) -> int:
    """Print the next hint, or all of them with --all."""
    lesson = context.load_course(arguments).find(arguments.exercise)
    workspace = context.require_workspace(arguments)
    count = len(lesson.hints)
    if arguments.all:
        if workspace.exists:
            workspace.progress(terminal.say).change(lambda progress: progress.with_hints(lesson.id, count))
        terminal.out("\n".join(_render_hint(number, lesson.hints) for number in range(1, count + 1)))
    elif not workspace.exists:
        terminal.out(_render_hint(1, lesson.hints))
        terminal.say(
            f"without a workspace, ros-tutor cannot remember which hints you have seen; "
            f"`{command('start', lesson.id)}` makes one, `{command('hint', lesson.id, '--all')}` shows them all"
        )
    else:
        number, again = workspace.progress(terminal.say).next_hint(lesson.id, total=count)
        terminal.out(_render_hint(number, lesson.hints))
        if again:
            terminal.say(f"that was the last hint, again; `{command('solution', lesson.id)}` shows our solution")
    return PASSED


def _render_hint(number: int, hints: tuple[str, ...]) -> str:
    heading = terminal.style(f"Hint {number} of {len(hints)}", "1", sys.stdout)
    return f"{heading}\n{terminal.wrap(hints[number - 1].strip(), terminal.width(sys.stdout))}"
