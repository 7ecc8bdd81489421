"""The command line of `ros2`: its commands and its exit codes."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Sequence
from types import FrameType
from typing import Any, NoReturn

from tutor.bundled_ros.ros2 import completion
from tutor.bundled_ros.ros2.parsing import PACKAGE, LazyParser, add_choices
from tutor.errors import CommandError
from tutor.ros import shared_memory
from tutor.terminal_text import guard_terminal

COMMANDS = {
    "action": "See actions, and send goals to them",
    "daemon": "Ask about the daemon, which this ros2 does without",
    "doctor": "Look for what is wrong with this machine",
    "interface": "See message, service and action types",
    "launch": "Start the nodes of a launch file",
    "node": "See the nodes",
    "param": "See and set the parameters of nodes",
    "pkg": "See the packages",
    "run": "Start a program of a package",
    "service": "See and call services",
    "topic": "See and publish messages on topics",
    "wtf": "The same as doctor",
}
"""Each command with its help text. A command is a module, or a package of verbs, of the same name in this package."""

_UNSUPPORTED_COMMANDS = frozenset(
    {"bag", "component", "control", "extension_points", "extensions", "lifecycle", "multicast", "security", "test"}
)


def main(argv: Sequence[str]) -> int:
    """Run `ros2 ARGV...` and return its exit code: 0, 1 for a failure, 2 for wrong usage or after Ctrl+C."""
    signal.signal(signal.SIGINT, signal.default_int_handler)  # background jobs inherit SIG_IGN
    signal.signal(signal.SIGTERM, _on_sigterm)
    try:
        return _run(argv)
    except KeyboardInterrupt:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # a second Ctrl+C would print a traceback
        return int(signal.SIGINT)
    except _Terminated:
        return int(signal.SIGTERM)
    except BrokenPipeError:  # as in `ros2 topic echo ... | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1


def build_parser() -> LazyParser:
    """Build the parser of the whole command line. Subparsers get their arguments only when they are used."""
    parser = LazyParser(prog="ros2", description="The ros2 command, where no ROS 2 is installed.")
    parser.add_argument(
        "--use-python-default-buffering",
        action="store_true",
        help="write to a pipe or a file in blocks, not line by line",
    )
    add_choices(parser, COMMANDS, lambda command: f"{PACKAGE}.{command}")
    return parser


def _run(argv: Sequence[str]) -> int:
    if argv and argv[0] in _UNSUPPORTED_COMMANDS:
        return _print_error(
            f"ros2: `ros2 {argv[0]}` needs an installed ROS 2; this ros2 knows: {', '.join(COMMANDS)}", 2
        )
    parser = build_parser()
    if completion.is_requested():
        completion.print_completions(parser)
    arguments = parser.parse_args(argv)
    sys.stdout, sys.stderr = guard_terminal(sys.stdout), guard_terminal(sys.stderr)
    if not arguments.use_python_default_buffering:
        _set_line_buffering(sys.stdout)
    try:
        if problem := shared_memory.problem():
            raise CommandError(problem)
        code = arguments.run(arguments)
    except CommandError as error:
        return _print_error(str(error), error.code)
    except (LookupError, RuntimeError) as error:  # including ROS's own RCLError
        return _print_error(str(error), 1)
    sys.stdout.flush()
    return int(code or 0)


def _set_line_buffering(stream: Any) -> None:
    if hasattr(stream, "reconfigure"):
        stream.reconfigure(line_buffering=True, errors="backslashreplace")


class _Terminated(BaseException):
    """SIGTERM was received."""


def _on_sigterm(_number: int, _frame: FrameType | None) -> NoReturn:
    raise _Terminated


def _print_error(text: str, code: int) -> int:
    sys.stdout.flush()
    print(text, file=sys.stderr)
    return code
