"""Finds the shell commands in a lesson's text, ready to be run as they stand."""

from __future__ import annotations

import re
from collections.abc import Iterator

LANGUAGES = ("bash", "sh", "shell", "console")
"""Info strings of fenced code blocks that show commands."""

_FENCE = re.compile(
    rf"^(?P<fence>`{{3,}}|~{{3,}})(?:{'|'.join(LANGUAGES)})[^\n]*\n(?P<text>.*?)^(?P=fence)[ \t]*$", re.M | re.S
)


def commands_in(markdown: str) -> tuple[str, ...]:
    r"""Return the commands in the text's shell examples, in order, without duplicates or comments, one line each.

    If an example has lines that begin with `$ `, only those are commands; the others are output.

    >>> commands_in("```bash\nros2 topic list  # all\nros2 run a b \\\n    --ros-args\n```\n")
    ('ros2 topic list', 'ros2 run a b --ros-args')
    """
    found = (command for example in _FENCE.finditer(markdown) for _, command in _commands(example["text"]) if command)
    return tuple(dict.fromkeys(found))


def command_at(example: str, line: int) -> str:
    """Return the command that line `line` (from 0) of an example belongs to, or "" if it is not part of one."""
    return next((command for lines, command in _commands(example) if line in lines), "")


def _commands(example: str) -> Iterator[tuple[range, str]]:
    """Yield each command with its range of lines."""
    lines = example.split("\n")
    prompted = any(line.startswith("$ ") for line in lines)
    start = 0
    while start < len(lines):
        end = start
        while end < len(lines) - 1 and lines[end].rstrip().endswith("\\"):
            end += 1
        joined = " ".join(line.strip().removesuffix("\\").rstrip() for line in lines[start : end + 1])
        if not prompted or joined.startswith("$ "):
            yield range(start, end + 1), _strip_comment(joined.removeprefix("$ "))
        start = end + 1


def _strip_comment(command: str) -> str:
    """Remove a trailing comment; a `#` inside quotes does not start one."""
    quote = ""
    for index, char in enumerate(command):
        if quote:
            quote = "" if char == quote else quote
        elif char in "\"'":
            quote = char
        elif char == "#" and command[index - 1 : index] in ("", " "):
            return command[:index].strip()
    return command.strip()
