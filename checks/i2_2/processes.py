"""I2.2: the output of a launch, split into its own lines and those of its processes."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from tutor.judge import tracebacks
from tutor.judge.trace import OutputLine
from tutor.judge.tracebacks import Traceback

_COLOUR = re.compile(r"\x1b\[[0-9;]*m")
_PREFIX = re.compile(r"^\[(?P<process>[^\]\s]+-\d+)\] ?(?P<text>.*)$")
_DIED = re.compile(r"\[(?P<process>[^\[\]\s]+-\d+)\]: process has died \[pid \d+, exit code (?P<code>-?\d+), cmd '")
_FINISHED = re.compile(r"\[(?P<process>[^\[\]\s]+-\d+)\]: process has finished cleanly")


@dataclass(frozen=True)
class EndedProcess:
    """A process that ended while the launch kept running. `process`: its name in the launch, such as "talker-1"."""

    process: str
    code: int
    output: tuple[OutputLine, ...]

    @property
    def traceback(self) -> Traceback | None:
        """The last traceback that the process printed, if any."""
        found = tracebacks.find_tracebacks(by_stream(self.output))
        return found[-1] if found else None


def ended_processes(output: Sequence[OutputLine]) -> list[EndedProcess]:
    """The processes that the launch reported as ended, in that order."""
    found = []
    for line in output:
        text = _COLOUR.sub("", line.text)
        if died := _DIED.search(text):
            found.append(EndedProcess(died["process"], int(died["code"]), written_by(output, died["process"])))
        elif finished := _FINISHED.search(text):
            found.append(EndedProcess(finished["process"], 0, written_by(output, finished["process"])))
    return found


def written_by(output: Iterable[OutputLine], process: str | None) -> tuple[OutputLine, ...]:
    """The lines of one process, without the launch's prefix; for None, the launch's own lines."""
    found = []
    for line in output:
        match = _PREFIX.match(_COLOUR.sub("", line.text))
        if match is None and process is None:
            found.append(line)
        elif match is not None and match["process"] == process:
            found.append(replace(line, text=match["text"]))
    return tuple(found)


def by_stream(output: Sequence[OutputLine]) -> tuple[OutputLine, ...]:
    """The lines of stdout, then those of stderr, as one stream: they may have arrived interleaved line by line."""
    return tuple(replace(line, stream="stderr") for line in sorted(output, key=lambda line: line.stream == "stderr"))


def writers(output: Sequence[OutputLine]) -> list[str]:
    """The names of all processes that wrote anything, in order of their first line."""
    matches = (_PREFIX.match(_COLOUR.sub("", line.text)) for line in output)
    return list(dict.fromkeys(match["process"] for match in matches if match))
