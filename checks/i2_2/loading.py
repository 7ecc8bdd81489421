"""I2.2: what launch says of a file that it cannot load. An installed ROS 2 says it in one line, without a traceback."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import dropwhile

from tutor.judge.trace import OutputLine, Trace
from tutor.judge.tracebacks import MOST_CHARACTERS, Frame, Traceback

_LOADING = re.compile(r"Caught (?:multiple exceptions|exception) when trying to load file of format \[")
_SAID = re.compile(r"^ - (?P<type>[^\W\d][\w.]*): (?P<message>.*)$")
_AT = re.compile(r" \((?P<file>[^()]+), line (?P<line>\d{1,9})\)$")
_OF_LAUNCH = re.compile(r"Invalid\w*LaunchFileError$")
_ZERO = re.compile(r"null bytes$")


def find_refusal(written: Iterable[OutputLine], trace: Trace) -> Traceback | None:
    """The exception with which a launch file was not loaded, with the place that it names; None where there is none."""
    lines = dropwhile(lambda text: not _LOADING.search(text), (line.text[:MOST_CHARACTERS] for line in written))
    for text in lines:
        if (said := _SAID.match(text)) and not _OF_LAUNCH.search(said["type"]):
            return _traceback(said["type"], said["message"], trace)
    return None


def _traceback(type: str, message: str, trace: Trace) -> Traceback:
    file, number = trace.file, 0
    if at := _AT.search(message):
        file, number, message = at["file"], int(at["line"]), message[: at.start()]
    code = trace.sources.get(file, "").split("\n")
    if _ZERO.search(message) and type == "SyntaxError":  # the one error of syntax for which Python names no place
        number = next((at for at, line in enumerate(code, 1) if "\0" in line), 0)
    if not number:
        return Traceback(type, message, ())
    line = code[number - 1].strip() if number <= len(code) else ""
    return Traceback(type, message, (Frame(f"{trace.folder.rstrip('/')}/{file}", number, "", line),))
