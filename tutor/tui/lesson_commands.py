"""The commands that a lesson's text shows, to be run as they stand."""

from __future__ import annotations

import re
from collections.abc import Iterator

LANGUAGES = ("bash", "sh", "shell", "console")
"""How a fenced example says that it shows commands."""

_FENCE = re.compile(
    rf"^(?P<fence>`{{3,}}|~{{3,}})(?:{'|'.join(LANGUAGES)})[^\n]*\n(?P<text>.*?)^(?P=fence)[ \t]*$", re.M | re.S
)


def commands_in(markdown: str) -> tuple[str, ...]:
    r"""The commands in the text's shell examples, in order, each once and in one line, without comments.

    Of an example with lines that begin with `$ `, only those are commands; the others are what is printed.

    >>> commands_in("```bash\nros2 topic list  # all\nros2 run a b \\\n    --ros-args\n```\n")
    ('ros2 topic list', 'ros2 run a b --ros-args')
    """
    found = (command for example in _FENCE.finditer(markdown) for _, command in _commands(example["text"]) if command)
    return tuple(dict.fromkeys(found))


def command_at(example: str, line: int) -> str:
    """The command that a line of an example, from 0, belongs to; empty where it shows none."""
    return next((command for lines, command in _commands(example) if line in lines), "")


def _commands(example: str) -> Iterator[tuple[range, str]]:
    """Each command with the lines that it takes."""
    lines = example.split("\n")
    prompted = any(line.startswith("$ ") for line in lines)
    start = 0
    while start < len(lines):
        end = start
        while end < len(lines) - 1 and lines[end].rstrip().endswith("\\"):
            end += 1
        whole = " ".join(line.strip().removesuffix("\\").rstrip() for line in lines[start : end + 1])
        if not prompted or whole.startswith("$ "):
            yield range(start, end + 1), _without_comment(whole.removeprefix("$ "))
        start = end + 1


def _without_comment(command: str) -> str:
    """A command without a comment at its end; a `#` in quotes begins none."""
    quote = ""
    for place, letter in enumerate(command):
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "\"'":
            quote = letter
        elif letter == "#" and command[place - 1 : place] in ("", " "):
            return command[:place].strip()
    return command.strip()
