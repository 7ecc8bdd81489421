"""The output of a launch, split into its own lines and those of its processes."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import dropwhile

from tutor.judge import tracebacks
from tutor.judge.trace import OutputLine, Trace
from tutor.judge.tracebacks import MAX_CHARACTERS, Frame, Traceback

_COLOUR = re.compile(r"\x1b\[[0-9;]*m")
_PREFIX = re.compile(r"^\[(?P<process>[^\]\s]+-\d+)\] ?(?P<text>.*)$")
_DIED = re.compile(r"\[(?P<process>[^\[\]\s]+-\d+)\]: process has died \[pid \d+, exit code (?P<code>-?\d+), cmd '")
_FINISHED = re.compile(r"\[(?P<process>[^\[\]\s]+-\d+)\]: process has finished cleanly")
_LOADING = re.compile(r"Caught (?:multiple exceptions|exception) when trying to load file of format \[")
_EXCEPTION = re.compile(r"^ - (?P<type>[^\W\d][\w.]*): (?P<message>.*)$")
_LOCATION = re.compile(r" \((?P<file>[^()]+), line (?P<line>\d{1,9})\)$")
_LAUNCH_EXCEPTION = re.compile(r"Invalid\w*LaunchFileError$")
_NULL_BYTES = re.compile(r"null bytes$")


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


def find_refusal(output: Iterable[OutputLine], trace: Trace) -> Traceback | None:
    """The exception that kept the launch file from being loaded, with its file and line; None if there is none.

    An installed ROS 2 reports it in one line, without a traceback.
    """
    lines = dropwhile(lambda text: not _LOADING.search(text), (line.text[:MAX_CHARACTERS] for line in output))
    for text in lines:
        if (reported := _EXCEPTION.match(text)) and not _LAUNCH_EXCEPTION.search(reported["type"]):
            return _traceback(reported["type"], reported["message"], trace)
    return None


def _traceback(type: str, message: str, trace: Trace) -> Traceback:
    file, number = trace.file, 0
    if location := _LOCATION.search(message):
        file, number, message = location["file"], int(location["line"]), message[: location.start()]
    source_lines = trace.sources.get(file, "").split("\n")
    # The only SyntaxError that Python reports without a line number.
    if _NULL_BYTES.search(message) and type == "SyntaxError":
        number = next((index for index, line in enumerate(source_lines, 1) if "\0" in line), 0)
    if not number:
        return Traceback(type, message, ())
    line = source_lines[number - 1].strip() if number <= len(source_lines) else ""
    return Traceback(type, message, (Frame(f"{trace.folder.rstrip('/')}/{file}", number, "", line),))
