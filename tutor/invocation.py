"""How this program was started, so that the commands that its texts name can be typed as they stand."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

PROGRAM = "ros-tutor"
VARIABLE = "ROS_TUTOR_STARTED_AS"
"""Holds a process id and how that process, or its child, was started. It says nothing to anybody further down: in a
terminal that was opened from here, the program may have another name."""

_COMMAND_IN_TEXT = re.compile(r"(^|`|\$ )ros-tutor(?=\s|`|$)", re.MULTILINE)


def program() -> str:
    """The word, or path, by which this program was started: `./ros-tutor` in a clone, `ros-tutor` where installed."""
    return detect_program_name(os.environ, sys.argv)


def command(*words: str | Path) -> str:
    """A command of this program, as it can be typed: `command("check", "i1.1")`."""
    return " ".join([program(), *(shlex.quote(str(word)) for word in words)])


def with_program_name(text: str) -> str:
    """A text in which the commands of this program, written `ros-tutor ...`, are as they can be typed."""
    word = program()
    return text if word == PROGRAM else _COMMAND_IN_TEXT.sub(lambda found: found[1] + word, text)


def export_program_name() -> None:
    """Let the processes that are started from this one (the engine, a served app) name its commands as it does."""
    os.environ[VARIABLE] = f"{os.getpid()} {program()}"


def detect_program_name(environ: Mapping[str, str], argv: Sequence[str]) -> str:
    """What `program` says, from these facts."""
    process, _, word = environ.get(VARIABLE, "").partition(" ")
    if word and process in (str(os.getpid()), str(os.getppid())):
        return word if word == PROGRAM else shlex.quote(word)
    started = argv[0] if argv else ""
    if os.path.basename(started) != PROGRAM or started in (PROGRAM, shutil.which(PROGRAM)):
        return PROGRAM
    return shlex.quote(os.path.relpath(started) if _is_below_here(started) else started)


def _is_below_here(path: str) -> bool:
    try:
        return Path(path).is_relative_to(Path.cwd())
    except OSError:  # the current folder was deleted
        return False
