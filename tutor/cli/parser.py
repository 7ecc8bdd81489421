"""The command line's grammar."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterable, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import Any, NoReturn

from tutor import __version__
from tutor.cli import (
    author,
    check,
    checklist,
    completion,
    diff,
    doctor,
    help_command,
    hint,
    list_exercises,
    next_exercise,
    reset,
    ros2,
    run_node,
    serve,
    shell,
    solution,
    start,
    watch,
)
from tutor.cli.errors import UsageError
from tutor.invocation import program

Run = Callable[[argparse.Namespace], int]


class _Parser(argparse.ArgumentParser):
    """Raises what is wrong, so that one place prints it."""

    def __init__(self, **options: Any) -> None:
        super().__init__(allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter, **options)

    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message} (see `{self.prog} --help`)")

    # argparse's own message lists everything there is, and guesses nothing.
    def _check_value(self, action: argparse.Action, value: Any) -> None:
        known = None if action.choices is None else [str(choice) for choice in action.choices]
        if known is None or value in known:
            return
        guess = did_you_mean(str(value), known)
        if isinstance(action, argparse._SubParsersAction):
            self.error(f"there is no command {value!r}{guess}")
        raise argparse.ArgumentError(action, f"invalid choice: {value!r}{guess}; choose from {', '.join(known)}")


class _CommandParser(_Parser):
    """Takes options between the positional arguments too: `check i1.1 --format json PATH`."""

    _mixing = False

    # argparse gives no other way in for a subcommand; the method below calls this one in turn.
    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        # Where all the rest of the line is another command's, options in it are not ours.
        if self._mixing or any(action.nargs == argparse.REMAINDER for action in self._actions):
            return super().parse_known_args(args, namespace)
        self._mixing = True
        try:
            return self.parse_known_intermixed_args(args, namespace)
        finally:
            self._mixing = False


_EPILOG = """\
Without a command, the terminal app opens.

exit codes: 0 passed, 1 not everything passed, 2 wrong usage, 3 a fault of the tool or the machine, 130 interrupted
"""


def parse(argv: Sequence[str] | None) -> argparse.Namespace:
    """Read the command line. `command` is None where there is none. Raises UsageError."""
    parser = build()
    words = list(sys.argv[1:] if argv is None else argv)
    words, rest = _nodes_own(words)
    arguments, unknown = parser.parse_known_args(words)
    if rest:
        arguments.rest = rest
    if unknown:
        used = command_parsers(parser).get(arguments.command, parser)
        options = [option for action in used._actions for option in action.option_strings]
        guess = did_you_mean(unknown[0].partition("=")[0], options) if unknown[0].startswith("-") else ""
        if arguments.command == "run":
            guess = "; what is your node's own follows --, as in -- --ros-args"
        used.error(f"unrecognized arguments: {' '.join(unknown)}{guess}")
    return arguments


def _nodes_own(words: list[str]) -> tuple[list[str], list[str]]:
    """What is ours, and what the node gets: for `run`, what follows the first `--`."""
    ours = words[: words.index("--")] if "--" in words else words
    takes_value = {"--workspace", "--lessons"}  # whose value, too, may be "run"
    pairs = zip(["", *ours], ours, strict=False)
    command = next((word for before, word in pairs if not word.startswith("-") and before not in takes_value), "")
    return (ours, words[len(ours) + 1 :]) if command == "run" else (words, [])


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """What was probably meant, as the end of a sentence; empty where nothing is near."""
    near = get_close_matches(word.lower(), list(known), n=1)
    return f", did you mean {near[0]}?" if near else ""


def command_parsers(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    """The parser of each command, by its name."""
    subparsers = next(action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    return dict(subparsers.choices)


def build(*, mixing: bool = True) -> argparse.ArgumentParser:
    """The parser of the whole command line. `mixing`: options may stand between a command's other arguments."""
    everywhere = _global_options()
    parser = _Parser(
        prog=program(),
        description="Hands-on ROS 2 exercises, judged by what your node really does.",
        epilog=_EPILOG,
        parents=[everywhere],
    )
    parser.set_defaults(command=None)
    parser.add_argument(
        "--plain", action="store_true", help="plain lines of text instead of the app, for screen readers"
    )
    commands = parser.add_subparsers(
        title="commands", metavar="COMMAND", parser_class=_CommandParser if mixing else _Parser
    )

    def add(name: str, run: Run, arguments: Callable[[argparse.ArgumentParser], None], help: str) -> None:
        command = commands.add_parser(name, help=help, description=_sentence(help), parents=[everywhere])
        arguments(command)
        command.set_defaults(command=name, run=run)

    add("list", list_exercises.run, list_exercises.add_arguments, "show the exercises, with your progress")
    add("start", start.run, start.add_arguments, "put the skeleton of an exercise into the workspace")
    add("next", next_exercise.run, next_exercise.add_arguments, "show the first exercise not passed, and what to do")
    add("check", check.run, check.add_arguments, "judge an exercise by what your node does")
    add("watch", watch.run, watch.add_arguments, "check again at each save, until Ctrl+C")
    add("run", run_node.run, run_node.add_arguments, "run your node in this terminal, until Ctrl+C")
    add("diff", diff.run, diff.add_arguments, "compare your file with the skeleton, or with our solution")
    add("reset", reset.run, reset.add_arguments, "put the skeleton back; your file is kept beside it")
    add("hint", hint.run, hint.add_arguments, "show the next hint for an exercise")
    add("solution", solution.run, solution.add_arguments, "print our solution of an exercise")
    add("checklist", checklist.run, checklist.add_arguments, "show, tick or export the self-assessment checklist")
    add("serve", serve.run, serve.add_arguments, "open the app in a browser, on this machine only")
    add("shell", shell.run, shell.add_arguments, "a shell in which ros2 works and your workspace is sourced")
    add("ros2", ros2.run, ros2.add_arguments, "the ros2 command, also without an installed ROS 2")
    add("completion", completion.run, completion.add_arguments, "print what makes Tab complete in bash, zsh or fish")
    add("doctor", doctor.run, doctor.add_arguments, "say what ROS is used, and what is wrong with the machine")
    add("help", help_command.run, help_command.add_arguments, "show what a command takes, or all commands")
    add("author", author.run, author.add_arguments, "prove a course right, for those who write one")
    return parser


def _global_options() -> _CommandParser:
    """Options that are good before and after the command. Suppressed defaults: the second must not undo the first."""
    parser = _CommandParser(add_help=False, argument_default=argparse.SUPPRESS)
    options = parser.add_argument_group("options for every command")
    options.add_argument(
        "--workspace",
        metavar="DIR",
        type=Path,
        help="your workspace (else $ROS_TUTOR_WORKSPACE, the one around the current folder, or ~/ros_tutor_ws)",
    )
    options.add_argument("--lessons", metavar="DIR", type=Path, help="a folder with more lessons/ and checks/")
    options.add_argument("--version", action="version", version=f"ros-tutor {__version__}", help="show the version")
    return parser


def _sentence(text: str) -> str:
    return f"{text[0].upper()}{text[1:]}."
