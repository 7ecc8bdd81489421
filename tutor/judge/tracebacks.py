"""Python tracebacks in a process's output, read as facts."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import groupby

from tutor.judge.trace import OutputLine, Trace

MAX_CHARACTERS = 1000
"""Maximum length of a traceback line; longer ones are cut, since the complex patterns applied to them are slow."""

_AT_EXIT = "Exception ignored in atexit callback"
_HEADER = "Traceback (most recent call last):"
_FRAME = re.compile(r'^\s*File "(?P<path>[^"]+)", line (?P<line>\d{1,9})(?:, in (?P<function>.+))?$')
_RAISED = re.compile(r"^(?P<type>[^\W\d][\w.]*(?:\.<locals>\.[\w.]+)*)(?:: (?P<message>.*))?$")
_DUMPED = re.compile(r'^  File "(?P<path>[^"]+)", line (?P<line>\d{1,9}) in (?P<function>.+)$')
_THREAD = re.compile(r"^(?:Current thread|Thread) 0x[0-9a-f]++.*\(most recent call first\):$")
_HEADERLESS = re.compile(
    r"^(?P<type>SyntaxError|MemoryError|RecursionError): "
    r"(?P<message>(?:Non-UTF-8 code .* in file (?P<path>.+) on line (?P<line>\d{1,9}),|encoding problem: |"
    r"Parser stack overflowed|.* during compilation$).*)$"
)
_COLOUR = re.compile(r"\x1b\[[0-9;]*m")
_GROUP = re.compile(r"^\s*\+ Exception Group Traceback \(most recent call last\):$")
_MARGIN = re.compile(r"^ {2,}(?:\| ?|\+ |\+(?:-\+)?-+(?: (?:\d+|\.\.\.) -+)?$)")
_CHAINED = (
    "During handling of the above exception, another exception occurred:",
    "The above exception was the direct cause of the following exception:",
)

_OF_NO_HELP = re.compile(
    r"\w+\(\): incompatible function arguments.*|.*Unable to (convert|cast).*call argument.*"
    r"|<built-in method \w+ of pybind11.*| This might be a ROS 1 message type.*"
    r"|, at /[\w/.-]+:\d+.*| \(/[^()]*\)(?=\.|$)"
)
"""What bindings and libraries add to a message: signatures in C++, places in their sources, a guess about ROS 1."""


@dataclass(frozen=True, slots=True)
class Frame:
    """One frame of a traceback. `function` is empty for a syntax error, which occurs in no function.

    `thread`: in a stack dump of all threads, the number of the frame's thread, counted from 1.
    """

    path: str
    line: int
    function: str
    code: str
    thread: int = field(default=0, compare=False)

    @property
    def name(self) -> str:
        """The file's name, without its folder."""
        return self.path.rsplit("/", 1)[-1]

    def __str__(self) -> str:
        return f"{self.name}, line {self.line}" + (f": {self.code}" if self.code else "")


@dataclass(frozen=True, slots=True)
class Traceback:
    """One traceback: the exception's type name, its message, and its frames, outermost first.

    `ignored`: Python reports it as "Exception ignored in", mostly from an object's cleanup; the program goes on.
    `at_exit`: such an ignored one, from a function registered with atexit. `follows`: the exception from which, or
    during whose handling, this one was raised.
    """

    type: str
    message: str
    frames: tuple[Frame, ...]
    ignored: bool = False
    follows: Traceback | None = None
    at_exit: bool = False

    @property
    def origin(self) -> Traceback:
        """The first exception of the chain, from which all others followed."""
        return self if self.follows is None else self.follows.origin

    @property
    def raised(self) -> str:
        """The last line of the traceback, as Python prints it."""
        return f"{self.type}: {self.message}" if self.message else self.type

    @property
    def plain_message(self) -> str:
        """The message, without what bindings and libraries add to it."""
        return _OF_NO_HELP.sub("", self.message).strip()

    @property
    def plain(self) -> str:
        """The exception in one line: its name without module, and its plain message."""
        name = self.type.rpartition(".")[2]
        return f"{name}: {self.plain_message}" if self.plain_message else name

    def own(self, folder: str) -> Frame | None:
        """The innermost frame in the learner's own code: the line that the learner can change."""
        return own_frame(reversed(self.frames), folder)


def find_tracebacks(output: Iterable[OutputLine]) -> tuple[Traceback, ...]:
    """All tracebacks in the output, oldest first, including headerless ones for a main file that fails to compile.

    An exception group is followed by the exceptions in it.
    """
    return tuple(_parse_tracebacks([line.text for line in output if line.stream == "stderr"]))


def dumped_frames(output: Iterable[OutputLine]) -> tuple[Frame, ...]:
    """The frames of all threads in a stack dump that faulthandler wrote on a fatal signal, innermost frame first."""
    frames: list[Frame] = []
    thread = 0
    for line in output:
        if line.stream != "stderr":
            continue
        if _THREAD.match(line.text):
            thread += 1
        elif m := _DUMPED.match(line.text):
            frames.append(Frame(m["path"], int(m["line"]), m["function"], "", thread))
    return tuple(frames)


def frames_by_thread(frames: Iterable[Frame]) -> tuple[tuple[Frame, ...], ...]:
    """The frames of each thread of a stack dump, innermost first."""
    return tuple(tuple(thread) for _, thread in groupby(frames, key=lambda frame: frame.thread))


def own_frame(frames: Iterable[Frame], folder: str) -> Frame | None:
    """The first of these frames that is in the learner's own code."""
    return next((frame for frame in frames if is_in_folder(frame.path, folder)), None)


def called_by_executor(stuck: Sequence[Frame], folder: str) -> bool:
    """Whether an rclpy executor is running the learner's code, as a callback. Frames are given innermost first."""
    own = next((i for i, frame in enumerate(stuck) if is_in_folder(frame.path, folder)), None)
    return own is not None and any(frame.path.endswith("rclpy/executors.py") for frame in stuck[own + 1 :])


def last_traceback(trace: Trace) -> Traceback | None:
    """The last traceback that the process wrote, or None.

    An ignored one counts only if there is no other: objects being cleaned up at exit complain after the actual crash.
    """
    found = find_tracebacks(trace.output)
    return next((traceback for traceback in reversed(found) if not traceback.ignored), found[-1] if found else None)


def failed_outside_callbacks(trace: Trace) -> bool:
    """Whether an exception ended the spin that no callback had raised: rclpy failed while it looked for work."""
    last = last_traceback(trace)
    paths = [frame.path for frame in last.frames] if last is not None else []
    return any(path.endswith("rclpy/executors.py") for path in paths) and not any(
        path.endswith("rclpy/task.py") for path in paths
    )


def lines_without_tracebacks(output: Sequence[OutputLine]) -> tuple[str, ...]:
    """The lines of the output without the frames of tracebacks; the line that names the exception is kept."""
    kept: list[str] = []
    inside = False
    plain = iter(_without_margins([line.text for line in output if line.stream == "stderr"]))
    for line in output:
        text = next(plain) if line.stream == "stderr" else line.text
        if line.stream == "stderr" and (text.strip() == _HEADER or _FRAME.match(text)):
            inside = True
            continue
        if inside and (text.startswith((" ", "\t")) or not text.strip()):
            continue
        if line.stream == "stderr" and text.strip() in _CHAINED:
            continue
        inside = False
        kept.append(text)
    return tuple(kept)


def _parse_tracebacks(written: Sequence[str]) -> Iterable[Traceback]:
    lines = _without_margins([_COLOUR.sub("", text)[:MAX_CHARACTERS] for text in written])
    frames: list[Frame] = []
    headed = ignored = at_exit = chained = False
    previous: Traceback | None = None
    for number, text in enumerate(lines):
        frame = _FRAME.match(text)
        if text.strip() == _HEADER:
            frames, headed = [], True
            before = lines[number - 1] if number else ""
            ignored, at_exit = before.startswith("Exception ignored"), before.startswith(_AT_EXIT)
        elif text.strip() in _CHAINED:
            chained = True
        elif frame:
            code = lines[number + 1].strip() if number + 1 < len(lines) else ""
            frames.append(Frame(frame["path"], int(frame["line"]), frame["function"] or "", code))
        elif not frames and not headed and (error := _HEADERLESS.match(text)):
            at = (Frame(error["path"], int(error["line"]), "", ""),) if error["path"] else ()
            yield Traceback(error["type"], error["message"], at)
        elif frames and (raised := _RAISED.match(text)):
            follows = previous if chained else None
            previous = Traceback(raised["type"], raised["message"] or "", tuple(frames), ignored, follows, at_exit)
            yield previous
            frames, headed, ignored, at_exit, chained = [], False, False, False, False
        elif text and not text[0].isspace() and not headed:
            frames = []  # right after a header, though, it is a line of another thread's, such as a log message


def _without_margins(lines: Sequence[str]) -> list[str]:
    """The lines, with the margins of exception groups removed so that each exception in them stands alone."""
    plain: list[str] = []
    inside = False
    for text in lines:
        inside = inside or _GROUP.match(text) is not None
        if not inside:
            plain.append(text)
        elif _GROUP.match(text):
            plain.append(_HEADER)
        elif margin := _MARGIN.match(text):
            inner = text[margin.end() :]
            plain.append(_HEADER if _GROUP.match(inner) else inner)
        else:
            inside = False
            plain.append(text)
    return plain


def is_in_folder(path: str, folder: str) -> bool:
    """Whether a file lies in the learner's folder and does not belong to an installed package."""
    return bool(folder) and path.startswith(folder.rstrip("/") + "/") and "/site-packages/" not in path
