"""The options that go with every command, and, without a command, with the app."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from tutor import __version__
from tutor.cli.grammar import CommandParser, Parser
from tutor.errors import UsageError
from tutor.invocation import program


def shared_options() -> CommandParser:
    """Return the options allowed both before and after the command.

    Their defaults are suppressed: otherwise the command's parser would overwrite a value given before the command.
    """
    parser = CommandParser(add_help=False, argument_default=argparse.SUPPRESS)
    options = parser.add_argument_group("options for every command")
    options.add_argument(
        "--workspace",
        metavar="DIR",
        type=Path,
        help="your workspace (else $ROS_TUTOR_WORKSPACE, the one around the current folder, or ~/ros_tutor_ws)",
    )
    options.add_argument(
        "--lessons",
        metavar="COURSE",
        action="append",
        help="more exercises: the folder of a course, a packed one, or the name of an installed one (repeatable; else "
        "$ROS_TUTOR_LESSONS, or those with which you started in your workspace)",
    )
    options.add_argument("--only", action="store_true", help="with --lessons: without our own exercises")
    options.add_argument("--version", action="version", version=f"ros-tutor {__version__}", help="show the version")
    return parser


def read_alone(argv: Sequence[str] | None) -> argparse.Namespace | None:
    """Read a command line of nothing but these options, which opens the app; return None for any other.

    The parser of all commands, which reads the others, takes a tenth of the time to the app's first paint.
    """
    parser = Parser(prog=program(), add_help=False, parents=[shared_options()])
    parser.set_defaults(command=None, plain=False)
    try:
        arguments, more = parser.parse_known_args(argv)
    except UsageError:
        return None  # the other parser reports it
    return None if more else arguments
