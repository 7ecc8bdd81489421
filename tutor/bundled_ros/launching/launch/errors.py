"""What the subset refuses, and where in the learner's own files a fault lies."""

from __future__ import annotations

import os.path
import sys
import sysconfig
import traceback
from types import FrameType
from typing import Any, NoReturn


class NotSupportedError(NotImplementedError):
    """The launch file uses a part of the real launch that this subset lacks."""

    __module__ = "launch"  # in a learner's traceback


def refuse(what: str) -> NoReturn:
    """Raise NotSupportedError for something that only the real launch has; `what` is its full name or a description."""
    raise NotSupportedError(
        f"{what} is not supported by the launch files that run without an installed ROS 2; "
        "it works where ROS 2 is installed and sourced"
    )


class _Refusing(type):
    """The metaclass of the stand-ins. They may appear in annotations and as base classes; any other use raises."""

    _what: str

    def __call__(cls, *args: Any, **kwargs: Any) -> NoReturn:
        refuse(cls._what)

    def __getattr__(cls, name: str) -> NoReturn:
        if name.startswith("__"):  # Python itself probes for optional dunder attributes
            raise AttributeError(name)
        refuse(f"{cls._what}.{name}")

    def __getitem__(cls, item: Any) -> NoReturn:
        refuse(cls._what)

    def __iter__(cls) -> NoReturn:
        refuse(cls._what)


def stand_in(what: str) -> type:
    """Return a class that stands in for the class, function or value of this full name."""
    module, _, name = what.rpartition(".")
    return _Refusing(name, (), {"__module__": module, "__doc__": "Not supported here.", "_what": what})


# --- the part of a traceback in the learner's own files, and the lines on which their actions are created

_OURS = os.path.abspath(os.path.join(__file__, *[os.pardir] * 4))  # with what runs us and finds packages
_FOREIGN = tuple(
    folder + os.sep for folder in (_OURS, *(sysconfig.get_path(key) for key in ("stdlib", "purelib", "platlib")))
)

Location = traceback.FrameSummary


def of_learner(error: BaseException) -> str | None:
    """Return the original error's traceback, reduced to the learner's own frames.

    If it has none, the line that created the failing action takes their place. None if that is unknown, too.
    """
    for candidate in reversed(_chain(error)):
        shown = traceback.TracebackException.from_exception(candidate, compact=True)
        shown.__cause__ = shown.__context__ = None
        frames = [frame for frame in shown.stack if not _is_foreign(frame.filename)]
        in_file = isinstance(candidate, SyntaxError) and not _is_foreign(str(candidate.filename))
        location: Location | None = getattr(candidate, "_place_of_action", None)
        if not frames and not in_file and location is not None:
            frames = [location]
        if frames or in_file:
            shown.stack = traceback.StackSummary.from_list(frames)
            return "".join(shown.format(chain=False)).rstrip()
    return None


def learner_location() -> Location | None:
    """Return the learner's line from which we were called; None if there is none."""
    frame: FrameType | None = sys._getframe(1)
    while frame is not None and _is_foreign(frame.f_code.co_filename):
        frame = frame.f_back
    if frame is None:
        return None
    return traceback.FrameSummary(frame.f_code.co_filename, frame.f_lineno, frame.f_code.co_name)


def note_location(error: Exception, location: Location | None) -> None:
    """Remember on an error which line created the action that raised it."""
    if location is not None and not hasattr(error, "_place_of_action"):
        error._place_of_action = location  # type: ignore[attr-defined]


def _is_foreign(filename: str) -> bool:
    return filename.startswith(("<frozen", "<string>")) or filename.startswith(_FOREIGN)


def _chain(error: BaseException) -> list[BaseException]:
    """Return the error followed by its causes, the original one last."""
    chain: list[BaseException] = []
    current: BaseException | None = error
    while current is not None and current not in chain:
        chain.append(current)
        current = current.__cause__ or (None if current.__suppress_context__ else current.__context__)
    return chain
