"""`ros-tutor help`: the help for all commands, or for one."""

from __future__ import annotations

import argparse

from tutor.cli import terminal
from tutor.cli.errors import PASSED
from tutor.cli.grammar import command_parsers, did_you_mean
from tutor.errors import UsageError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `[COMMAND]`."""
    parser.add_argument("topic", metavar="COMMAND", nargs="?", help="for example check (else all commands)")


def run(arguments: argparse.Namespace) -> int:
    """Print what `--help` prints for the command, or for `ros-tutor` itself."""
    parser: argparse.ArgumentParser = arguments.parser
    if arguments.topic is not None:
        known = command_parsers(parser)
        if arguments.topic not in known:
            raise UsageError(f"there is no command {arguments.topic!r}{did_you_mean(arguments.topic, known)}")
        parser = known[arguments.topic]
    terminal.out(parser.format_help())
    return PASSED
