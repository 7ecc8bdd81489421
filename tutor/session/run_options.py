"""Parameters and remaps for a learner's node, in the syntax of `ros2 run`. Pure functions."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

from tutor.bundled_ros.ros2.starting import is_launch_file
from tutor.workspace import RunOptions

_PARAMETER = re.compile(r"(?:[A-Za-z_/*][\w/*]*:)?[A-Za-z_][\w.]*:=\S.*")
_REMAP = re.compile(
    r"(?:[A-Za-z_]\w*:)?(?:__(?:node|name|ns)|(?:~/|/)?[A-Za-z_][\w/]*):=(?:~/|/)?[A-Za-z_][\w/]*|__ns:=/"
)
_ARGUMENT = re.compile(r"[A-Za-z_][\w.-]*:=.+")


def lines(text: str) -> tuple[str, ...]:
    """Return the stripped lines of `text`, without empty ones and comments (# at the start)."""
    stripped = (line.strip() for line in text.splitlines())
    return tuple(line for line in stripped if line and not line.startswith("#"))


def problem(options: RunOptions, *, launch: bool) -> str:
    """Return an error message for the first invalid line, with the expected syntax; empty if all are valid."""
    for line in options.parameters:
        if launch and not _ARGUMENT.fullmatch(line):
            return f"'{line}' is not a launch argument: write name:=value, as in topic:=my_topic"
        if not launch and not _PARAMETER.fullmatch(line):
            return f"'{line}' sets no parameter: write name:=value, as in publish_rate:=2.0"
    for line in options.remaps:
        if not _REMAP.fullmatch(line):
            return f"'{line}' remaps nothing: write from:=to, as in chatter:=/news, __node:=other or __ns:=/robot1"
    return ""


def arguments(options: RunOptions, *, launch: bool) -> list[str]:
    """Return the command-line arguments that follow the program's name."""
    if launch:
        return list(options.parameters)
    words = [word for line in options.parameters for word in ("-p", line)]
    words += [word for line in options.remaps for word in ("-r", line)]
    return ["--ros-args", *words] if words else []


def command_line(package: str, file: str, options: RunOptions) -> str:
    """Return the command that a ROS user types to run this file of a built package."""
    launch = is_launch_file(Path(file))
    program = file if launch else Path(file).stem
    words = ["ros2", "launch" if launch else "run", package, program, *arguments(options, launch=launch)]
    return shlex.join(words)
