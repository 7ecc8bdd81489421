"""I2.2: how launch reports a file that it cannot load.

An installed ROS 2 reports the exception in one line, without a traceback.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import dropwhile

from tutor.judge.trace import OutputLine, Trace
from tutor.judge.tracebacks import MAX_CHARACTERS, Frame, Traceback

_LOADING = re.compile(r"Caught (?:multiple exceptions|exception) when trying to load file of format \[")
_EXCEPTION = re.compile(r"^ - (?P<type>[^\W\d][\w.]*): (?P<message>.*)$")
_LOCATION = re.compile(r" \((?P<file>[^()]+), line (?P<line>\d{1,9})\)$")
_LAUNCH_EXCEPTION = re.compile(r"Invalid\w*LaunchFileError$")
_NULL_BYTES = re.compile(r"null bytes$")


def find_refusal(output: Iterable[OutputLine], trace: Trace) -> Traceback | None:
    """The exception that prevented the launch file from being loaded, with its file and line; None if there is none."""
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
