"""The command line of `ros2`: its commands, and how it ends."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Sequence
from types import FrameType
from typing import Any, NoReturn

from tutor.bundled_ros.ros2 import completing
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
}
"""Each command and what it is for; it is the module (or the package of verbs) of this name in this package."""

_ELSEWHERE = ("bag", "component", "control", "lifecycle", "multicast", "security")


def main(argv: Sequence[str]) -> int:
    """Run `ros2 ARGV...`; gives its exit code: 0, 1 where it cannot be done, 2 for wrong usage and after Ctrl+C."""
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a job in the background has inherited an ignored one
    signal.signal(signal.SIGTERM, _terminated)
    try:
        return _run(argv)
    except KeyboardInterrupt:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # pressed once more, it would end in a traceback
        return int(signal.SIGINT)
    except _Terminated:
        return int(signal.SIGTERM)
    except BrokenPipeError:  # as in `ros2 topic echo ... | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1


def build_parser() -> LazyParser:
    """The parser of the whole command line; that of a command or a verb is filled when it is reached."""
    parser = LazyParser(prog="ros2", description="The ros2 command, where no ROS 2 is installed.")
    parser.add_argument(
        "--use-python-default-buffering",
        action="store_true",
        help="write to a pipe or a file in blocks, not line by line",
    )
    add_choices(parser, COMMANDS, lambda command: f"{PACKAGE}.{command}")
    return parser


def _run(argv: Sequence[str]) -> int:
    if argv and argv[0] in _ELSEWHERE:
        return _say(f"ros2: `ros2 {argv[0]}` needs an installed ROS 2; this ros2 knows: {', '.join(COMMANDS)}", 2)
    parser = build_parser()
    if completing.is_asked():
        completing.answer(parser)
    arguments = parser.parse_args(argv)
    sys.stdout, sys.stderr = guard_terminal(sys.stdout), guard_terminal(sys.stderr)
    if not arguments.use_python_default_buffering:
        _write_by_lines(sys.stdout)
    try:
        if problem := shared_memory.problem():
            raise CommandError(problem)
        code = arguments.run(arguments)
    except CommandError as error:
        return _say(str(error), error.code)
    except (LookupError, RuntimeError) as error:  # among them what ROS itself refuses, as an RCLError
        return _say(str(error), 1)
    sys.stdout.flush()
    return int(code or 0)


def _write_by_lines(stream: Any) -> None:
    if hasattr(stream, "reconfigure"):
        stream.reconfigure(line_buffering=True, errors="backslashreplace")


class _Terminated(BaseException):
    """SIGTERM has come."""


def _terminated(_number: int, _frame: FrameType | None) -> NoReturn:
    raise _Terminated


def _say(text: str, code: int) -> int:
    sys.stdout.flush()
    print(text, file=sys.stderr)
    return code
