"""`ros-tutor author`: make and verify a course, for course authors."""

from __future__ import annotations

import argparse
from pathlib import Path

from tutor.errors import UsageError

_ACTIONS = ("check",)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `check [EXERCISE...] [--static] [--watch] [--submissions DIR]`."""
    parser.add_argument("action", metavar="ACTION", choices=_ACTIONS, help="check: verify lessons and their checks")
    parser.add_argument(
        "exercises",
        metavar="EXERCISE",
        nargs="*",
        help="only these, or only this submission: x1.1/wrong/NAME (else all; with --lessons, its own)",
    )
    parser.add_argument("--static", action="store_true", help="only read; run nothing")
    parser.add_argument("--watch", action="store_true", help="prove again what you change, until Ctrl+C")
    parser.add_argument(
        "--submissions", metavar="DIR", type=Path, help="the test submissions (else submissions/ in the course)"
    )


def run(arguments: argparse.Namespace) -> int:
    """Carry out the action."""
    from tutor.cli import author_check, author_watch

    if arguments.watch and arguments.static:
        raise UsageError("--watch runs what you change; --static runs nothing")
    return author_watch.run(arguments) if arguments.watch else author_check.run(arguments)
