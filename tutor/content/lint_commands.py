"""Lints the commands in a lesson: a learner can type them as they are, because their files and options exist."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable, Collection, Iterator

from tutor.content.model import Lesson
from tutor.content.problem import Problem

_BLOCK = re.compile(r"^```(?:bash|sh|shell|console)\n(.*?)^```", re.MULTILINE | re.DOTALL)
_SCRIPT = re.compile(r"[\w./~-]*?([\w-]+\.(?:py|xml|yaml|yml))")
_PACKAGE = "my_package"


def commands(body: str) -> Iterator[list[str]]:
    """Yield the words of each command in the shell blocks of a lesson; a trailing backslash continues a line.

    If any line of a block begins with `$ `, only such lines are commands and the others are their output.
    """
    for block in _BLOCK.findall(body):
        lines = block.replace("\\\n", " ").splitlines()
        prompted = [line for line in lines if line.startswith("$ ")]
        for line in prompted or lines:
            try:
                words = shlex.split(line.removeprefix("$ "), comments=True)
            except ValueError:
                words = line.split()
            if words:
                yield words


def find_bad_commands(lesson: Lesson, given: Collection[str], usage: Callable[[list[str]], str]) -> Iterator[Problem]:
    """Find commands that would fail for a learner.

    `given` holds the names of the files in every workspace. `usage` returns the usage error for arguments of
    `ros-tutor`, or "" if they are valid.
    """
    source = lesson.folder / "lesson.md"
    known = {*given, *(file.name for file in lesson.files)}
    for words in commands(lesson.body):
        line = " ".join(words)
        for word in words:
            script = _SCRIPT.fullmatch(word)
            if script and script[1] not in known:
                yield Problem(source, f"`{line}`: there is no file {script[1]}", f"use {' or '.join(sorted(known))}")
        if words[:3] == ["ros2", "run", _PACKAGE] and len(words) > 3 and f"{words[3]}.py" not in known:
            yield Problem(source, f"`{line}`: {_PACKAGE} has no program {words[3]}", "name a file without its .py")
        if words[0] == "ros-tutor":
            if wrong := usage(words[1:]):
                yield Problem(source, f"`{line}`: {wrong}", "write a command that works")
            elif "--criterion" in words[:-1]:
                name = words[words.index("--criterion") + 1]
                if name not in {criterion.id for criterion in lesson.criteria}:
                    yield Problem(source, f"`{line}`: there is no criterion {name}", "name one of this lesson")
