"""Records of what the real `ros2` printed, one file per command.

The format is described in the README beside the records: comment lines, `$ command`, then the sections `stdout`,
`stderr`, `exit code` and `ended`.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Output:
    """What a command printed, and its exit code. On a terminal, stderr is part of stdout."""

    stdout: str
    stderr: str
    code: int


@dataclass(frozen=True, slots=True)
class Record:
    """One command: how it was run, with which nodes up, and its output."""

    name: str
    running: str
    command: str
    on_terminal: bool
    stdin: bytes | None
    interrupt_after_s: float | None  # when Ctrl+C was pressed; None if it exited by itself
    output: Output

    @property
    def session(self) -> int:
        """The number before the first underscore of the name; records of one session share their nodes."""
        found = re.match(r"s(\d+)_", self.name)
        return int(found[1]) if found else 0


_FORMAT = re.compile(
    r"(?P<head>(?:#[^\n]*\n)*)\$ (?P<command>.*?)\n--- stdout\n(?P<stdout>.*?)--- stderr\n(?P<stderr>.*?)"
    r"--- exit code: (?P<code>-?\d+)\n--- ended: (?P<ended>[^\n]*)\n?\Z",
    re.DOTALL,
)


def read(file: Path) -> Record:
    """Parse one file. Raise ValueError if it does not have the format."""
    found = _FORMAT.match(file.read_text(encoding="utf-8"))
    if found is None:
        raise ValueError(f"{file} is not a record of a command")
    head = dict(line.removeprefix("# ").split(": ", 1) for line in found["head"].splitlines() if ": " in line)
    interrupted = re.match(r"Ctrl\+C after ([\d.]+) s", found["ended"])
    return Record(
        name=file.stem,
        running=head.get("running", "no nodes"),
        command=found["command"].strip(),
        on_terminal=head.get("on a terminal", "no").startswith("yes"),
        stdin=ast.literal_eval(head["stdin"]).encode() if "stdin" in head else None,
        interrupt_after_s=float(interrupted[1]) if interrupted else None,
        output=Output(found["stdout"], found["stderr"], int(found["code"])),
    )


def read_all(folder: Path) -> list[Record]:
    """Read all records in a folder, in the order in which they were made."""
    return sorted((read(file) for file in folder.glob("s*_*.txt")), key=lambda record: (record.session, record.name))
