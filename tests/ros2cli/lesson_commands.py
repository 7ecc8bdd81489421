"""The commands of a lesson's text, with what the lesson shows of their output."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass

_BLOCK = re.compile(r"^```(bash|sh|shell|console)\n(.*?)^```", re.MULTILINE | re.DOTALL)
_ELSEWHERE = "..."
# What differs from run to run, or from machine to machine.
_VARIES = (
    (re.compile(r"\[\d{10}\.\d{6,}\]"), "[time]"),
    (re.compile(r"-?\d+\.\d{3,}"), "<number>"),
    (re.compile(r"window: \d+"), "window: <number>"),
    (re.compile(r"Hello World: \d+"), "Hello World: <number>"),
    (re.compile(r"pid \[\d+\]"), "pid [<number>]"),
    (re.compile(r"[ \t]+"), " "),
)


@dataclass(frozen=True)
class Command:
    """A command as it is typed, and the lines that the lesson shows below it; `...` stands for any."""

    line: str
    shown: tuple[str, ...]

    def shows(self, output: str) -> bool:
        """Whether the output begins as the lesson shows it, but for what varies."""
        pattern = "".join(_pattern(line) for line in self.shown)
        return re.match(pattern, _steady(output)) is not None


def commands(body: str) -> Iterator[Command]:
    """The commands of all shell blocks, in order."""
    for kind, block in _BLOCK.findall(body):
        lines = block.splitlines()
        while lines:
            line = lines.pop(0)
            if kind == "console" and not line.startswith("$ "):
                raise ValueError(f"{line!r} is below no command")
            line = line.removeprefix("$ ")
            while lines and not _is_whole(line):
                line += f"\n{lines.pop(0)}"
            shown: list[str] = []
            while kind == "console" and lines and not lines[0].startswith("$ "):
                shown.append(lines.pop(0))
            if line.strip() and not line.startswith("#"):
                yield Command(line, tuple(shown))


def _is_whole(text: str) -> bool:
    """Whether bash would not wait for more."""
    if text.endswith("\\"):
        return False
    return subprocess.run(["bash", "-n", "-c", text], capture_output=True, check=False).returncode == 0


def _pattern(line: str) -> str:
    if line.strip() == _ELSEWHERE:
        return r"(?:.*\n)*?"
    return ".*".join(map(re.escape, _steady(line).split(_ELSEWHERE))) + r"\s*\n"


def _steady(text: str) -> str:
    for varies, put in _VARIES:
        text = varies.sub(put, text)
    return text
