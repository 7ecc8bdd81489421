"""`ros-tutor`: the terminal app."""

from __future__ import annotations

import argparse
import sys

from tutor.cli import context, terminal
from tutor.cli.errors import UsageError


def run(arguments: argparse.Namespace) -> int:
    """Open the app; it needs a terminal."""
    if not (terminal.is_terminal(sys.stdin) and terminal.is_terminal(sys.stdout)):
        raise UsageError("the app needs a terminal; without one, use a command (`ros-tutor --help` names them)")
    from tutor.tui import run

    return run(context.place(arguments).root, getattr(arguments, "lessons", None))
