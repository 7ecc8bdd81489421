"""Records of what the real `ros2` printed: one file, one command.

The form is described in the README beside the records: comment lines, `$ command`, then the sections `stdout`,
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
    """One command: where, how and with which nodes up it was run, and what it did."""

    name: str
    running: str
    command: str
    on_terminal: bool
    stdin: bytes | None
    interrupt_after_s: float | None  # Ctrl+C was pressed then; None: it ended by itself
    output: Output

    @property
    def session(self) -> int:
        """The number before the first underscore: records of one session share their nodes."""
        found = re.match(r"s(\d+)_", self.name)
        return int(found[1]) if found else 0


_SHAPE = re.compile(
    r"(?P<head>(?:#[^\n]*\n)*)\$ (?P<command>.*?)\n--- stdout\n(?P<stdout>.*?)--- stderr\n(?P<stderr>.*?)"
    r"--- exit code: (?P<code>-?\d+)\n--- ended: (?P<ended>[^\n]*)\n?\Z",
    re.DOTALL,
)


def read(file: Path) -> Record:
    """Parse one file. Raises ValueError where it does not have the form."""
    found = _SHAPE.match(file.read_text(encoding="utf-8"))
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
    """Every record of a folder, in the order in which they were made."""
    return sorted((read(file) for file in folder.glob("s*_*.txt")), key=lambda record: (record.session, record.name))
