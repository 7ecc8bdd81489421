"""The shell commands in a lesson's text, with the output that the lesson shows for them."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass

_BLOCK = re.compile(r"^```(bash|sh|shell|console)\n(.*?)^```", re.MULTILINE | re.DOTALL)
_ELLIPSIS = "..."
# Text that differs between runs or machines, and its placeholders.
_VOLATILE = (
    (re.compile(r"\[\d{10}\.\d{6,}\]"), "[time]"),
    (re.compile(r"-?\d+\.\d{3,}"), "<number>"),
    (re.compile(r"window: \d+"), "window: <number>"),
    (re.compile(r"Hello World: \d+"), "Hello World: <number>"),
    (re.compile(r"pid \[\d+\]"), "pid [<number>]"),
    (re.compile(r"[ \t]+"), " "),
)


@dataclass(frozen=True)
class Command:
    """A command as typed, and the output lines that the lesson shows below it; `...` stands for any text."""

    line: str
    shown: tuple[str, ...]

    def matches(self, output: str) -> bool:
        """Return whether the output begins as the lesson shows it, apart from volatile text."""
        pattern = "".join(_line_pattern(line) for line in self.shown)
        return re.match(pattern, _mask_volatile(output)) is not None


def find_commands(body: str) -> Iterator[Command]:
    """Yield the commands of all shell blocks, in order."""
    for kind, block in _BLOCK.findall(body):
        lines = block.splitlines()
        while lines:
            line = lines.pop(0)
            if kind == "console" and not line.startswith("$ "):
                raise ValueError(f"{line!r} does not follow a command")
            line = line.removeprefix("$ ")
            while lines and not _is_complete(line):
                line += f"\n{lines.pop(0)}"
            shown: list[str] = []
            while kind == "console" and lines and not lines[0].startswith("$ "):
                shown.append(lines.pop(0))
            if line.strip() and not line.startswith("#"):
                yield Command(line, tuple(shown))


def _is_complete(text: str) -> bool:
    """Return whether bash would run this without waiting for more lines."""
    if text.endswith("\\"):
        return False
    return subprocess.run(["bash", "-n", "-c", text], capture_output=True, check=False).returncode == 0


def _line_pattern(line: str) -> str:
    if line.strip() == _ELLIPSIS:
        return r"(?:.*\n)*?"
    return ".*".join(map(re.escape, _mask_volatile(line).split(_ELLIPSIS))) + r"\s*\n"


def _mask_volatile(text: str) -> str:
    for pattern, placeholder in _VOLATILE:
        text = pattern.sub(placeholder, text)
    return text
