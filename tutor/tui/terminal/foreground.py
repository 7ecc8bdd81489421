"""The name of the program that runs in a terminal, for its tab."""

from __future__ import annotations

import re
from pathlib import PurePath

from tutor import run_module
from tutor.terminal_text import strip_ansi

_MAX_BYTES = 4096
_RUN_MODULE = PurePath(run_module.__file__).name
_INTERPRETER = re.compile(r"python[\d.]*|-?(?:ba|z|da)?sh")


def describe_foreground(group: int) -> str:
    """Return what runs in a process group as one would type it, roughly: `ros2 topic echo /chatter`; "" if nothing."""
    try:
        with open(f"/proc/{group}/cmdline", "rb") as file:
            words = file.read(_MAX_BYTES).decode("utf-8", "replace").rstrip("\0").split("\0")
    except OSError:
        return ""
    return strip_ansi(describe(words))


def describe(words: list[str]) -> str:
    """Return a command line without its paths and its interpreter.

    >>> describe(["/usr/bin/python3", "-P", "/opt/tutor/run_module.py", "tutor.bundled_ros.ros2", "topic", "list"])
    'ros2 topic list'
    >>> describe(["/bin/sh", "/tmp/bin/ros2", "topic"]), describe(["/bin/bash", "--rcfile", "rc", "-i"])
    ('ros2 topic', 'bash')
    """
    program, *rest = words
    name = PurePath(program).name.removeprefix("-")
    if not _INTERPRETER.fullmatch(PurePath(program).name):
        return " ".join([name, *rest])
    for index, word in enumerate(rest):
        if (word == "-m" or PurePath(word).name == _RUN_MODULE) and rest[index + 1 :]:
            return " ".join([rest[index + 1].rpartition(".")[2], *rest[index + 2 :]])
        if word in ("-c", "--rcfile"):
            break
        if not word.startswith("-"):
            return " ".join([PurePath(word).name, *rest[index + 1 :]])
    return name
