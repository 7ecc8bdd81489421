"""How this program was started, so that the commands shown in its texts can be typed verbatim."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

PROGRAM = "ros-tutor"
STARTED_AS_VARIABLE = "ROS_TUTOR_STARTED_AS"
"""Holds a process id and the name by which that process was started. It only counts for that process and its children:
in a terminal opened from here, the program may have another name."""

_COMMAND_IN_TEXT = re.compile(r"(^|`|\$ )ros-tutor(?=\s|`|$)", re.MULTILINE)


def program() -> str:
    """Return the name or path by which this program was started: `./ros-tutor` in a clone, `ros-tutor` if installed."""
    return detect_program_name(os.environ, sys.argv)


def command(*words: str | Path) -> str:
    """Return a command of this program as the user can type it. Example: `command("check", "i1.1")`."""
    return " ".join([program(), *(shlex.quote(str(word)) for word in words)])


def with_program_name(text: str) -> str:
    """Replace `ros-tutor` in the commands shown in a text with the name that the user can type."""
    name = program()
    return text if name == PROGRAM else _COMMAND_IN_TEXT.sub(lambda match: match[1] + name, text)


def export_program_name() -> None:
    """Make the children of this process (the engine, a served app) use the same program name."""
    os.environ[STARTED_AS_VARIABLE] = f"{os.getpid()} {program()}"


def detect_program_name(environ: Mapping[str, str], argv: Sequence[str]) -> str:
    """Return what `program` does, given an environment and argv."""
    pid, _, name = environ.get(STARTED_AS_VARIABLE, "").partition(" ")
    if name and pid in (str(os.getpid()), str(os.getppid())):
        return name if name == PROGRAM else shlex.quote(name)
    started = argv[0] if argv else ""
    if os.path.basename(started) != PROGRAM or started in (PROGRAM, shutil.which(PROGRAM)):
        return PROGRAM
    return shlex.quote(os.path.relpath(started) if _is_below_here(started) else started)


def _is_below_here(path: str) -> bool:
    try:
        return Path(path).is_relative_to(Path.cwd())
    except OSError:  # the current folder was deleted
        return False
