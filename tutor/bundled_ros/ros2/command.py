"""The command line of `ros2`: its commands and its exit codes."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Sequence
from types import FrameType
from typing import Any, NoReturn

from tutor.bundled_ros.ros2 import completion
from tutor.bundled_ros.ros2.parsing import Group, LazyParser, Verbs, fill, flag
from tutor.errors import CommandError
from tutor.ros import shared_memory
from tutor.terminal_text import guard_terminal

_COMMANDS: Verbs = {
    "action": ("See actions, and send goals to them", "action"),
    "daemon": ("Ask about the daemon, which this ros2 does without", "daemon"),
    "doctor": ("Look for what is wrong with this machine", "doctor"),
    "interface": ("See message, service and action types", "interface"),
    "launch": ("Start the nodes of a launch file", "launch"),
    "lifecycle": ("See and change the states of lifecycle nodes", "lifecycle"),
    "node": ("See the nodes", "node"),
    "param": ("See and set the parameters of nodes", "param"),
    "pkg": ("See the packages", "pkg"),
    "run": ("Start a program of a package", "run"),
    "service": ("See and call services", "service"),
    "topic": ("See and publish messages on topics", "topic"),
    "wtf": ("The same as doctor", "doctor"),
}
_GRAMMAR = Group(
    _COMMANDS,
    flag("--use-python-default-buffering", help="write to a pipe or a file in blocks, not line by line"),
)

_UNSUPPORTED_COMMANDS = frozenset(
    {"bag", "component", "control", "extension_points", "extensions", "multicast", "security", "test"}
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
    description = "The ros2 command, where no ROS 2 is installed."
    return LazyParser(prog="ros2", description=description, fill=lambda parser: fill(parser, _GRAMMAR))


def _run(argv: Sequence[str]) -> int:
    if argv and argv[0] in _UNSUPPORTED_COMMANDS:
        return _print_error(
            f"ros2: `ros2 {argv[0]}` needs an installed ROS 2; this ros2 knows: {', '.join(_COMMANDS)}", 2
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
