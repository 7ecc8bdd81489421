"""Parsing rules shared by all commands: error messages, suggestions, and options between positional arguments."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from typing import Any, NoReturn

from tutor.errors import UsageError


class Parser(argparse.ArgumentParser):
    """Raises UsageError instead of printing and exiting, so that one place prints all errors."""

    def __init__(self, **options: Any) -> None:
        super().__init__(allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter, **options)

    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message} (see `{self.prog} --help`)")

    # argparse's own message lists every choice and suggests none.
    def _check_value(self, action: argparse.Action, value: Any) -> None:
        known = None if action.choices is None else [str(choice) for choice in action.choices]
        if known is None or value in known:
            return
        guess = did_you_mean(str(value), known)
        if isinstance(action, argparse._SubParsersAction):
            self.error(f"there is no command {value!r}{guess}")
        raise argparse.ArgumentError(action, f"invalid choice: {value!r}{guess}; choose from {', '.join(known)}")


class CommandParser(Parser):
    """Also accepts options between positional arguments: `check i1.1 --format json PATH`."""

    _intermixing = False

    # The only hook that argparse offers for a subcommand; parse_known_intermixed_args calls it in turn.
    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        # If the rest of the line belongs to another command (REMAINDER), its options are not ours.
        if self._intermixing or any(action.nargs == argparse.REMAINDER for action in self._actions):
            return super().parse_known_args(args, namespace)
        self._intermixing = True
        try:
            return self.parse_known_intermixed_args(args, namespace)
        finally:
            self._intermixing = False


def read(parser: argparse.ArgumentParser, argv: Sequence[str] | None) -> argparse.Namespace:
    """Read the command line; `command` is None if none was given. Raises UsageError."""
    words = list(sys.argv[1:] if argv is None else argv)
    words, rest = _split_node_arguments(words)
    arguments, unknown = parser.parse_known_args(words)
    if rest:
        arguments.rest = rest
    if unknown:
        used = command_parsers(parser).get(arguments.command, parser)
        options = [option for action in used._actions for option in action.option_strings]
        guess = did_you_mean(unknown[0].partition("=")[0], options) if unknown[0].startswith("-") else ""
        if arguments.command == "run":
            guess = "; put your node's own arguments after --, as in -- --ros-args"
        used.error(f"unrecognized arguments: {' '.join(unknown)}{guess}")
    return arguments


def _split_node_arguments(words: list[str]) -> tuple[list[str], list[str]]:
    """Return our arguments, and those of the node: for `run`, everything after the first `--`."""
    ours = words[: words.index("--")] if "--" in words else words
    takes_value = {"--workspace", "--lessons"}  # the value of one of these may be "run" as well
    pairs = zip(["", *ours], ours, strict=False)
    command = next((word for before, word in pairs if not word.startswith("-") and before not in takes_value), "")
    return (ours, words[len(ours) + 1 :]) if command == "run" else (words, [])


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return `, did you mean X?` for the closest of `known`; empty if none is close."""
    near = get_close_matches(word.lower(), list(known), n=1)
    return f", did you mean {near[0]}?" if near else ""


def command_parsers(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    """Return the parser of each command, by command name."""
    subparsers = next(action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    return dict(subparsers.choices)
