"""`ros-tutor`, the terminal app, and `ros-tutor --plain`, the same course as plain lines of text."""

from __future__ import annotations

import argparse
import sys

from tutor.cli import context, terminal
from tutor.errors import UsageError
from tutor.invocation import command


def run(arguments: argparse.Namespace) -> int:
    """Open the app, which needs a terminal, or the plain-text dialog, which does not."""
    root, courses = context.choose_workspace(arguments).root, context.choose_courses(arguments)
    if arguments.plain:
        from tutor.plain import run as talk

        return talk(root, terminal.out, courses)
    if not (terminal.is_terminal(sys.stdin) and terminal.is_terminal(sys.stdout)):
        raise UsageError(
            f"the app needs a terminal; without one, use a command (`{command('help')}` names them) or --plain"
        )
    from tutor.tui import run

    return run(root, courses)
