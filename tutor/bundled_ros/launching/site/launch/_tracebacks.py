"""The part of a traceback that lies in the learner's own files, and the lines there that actions are written on."""

from __future__ import annotations

import os.path
import sys
import sysconfig
import traceback
from types import FrameType

_OURS = os.path.abspath(os.path.join(__file__, *[os.pardir] * 4))  # with those who run us and find packages for us
_FOREIGN = tuple(
    folder + os.sep for folder in (_OURS, *(sysconfig.get_path(key) for key in ("stdlib", "purelib", "platlib")))
)

Place = traceback.FrameSummary


def of_learner(error: BaseException) -> str | None:
    """The traceback of what first went wrong, without the frames of others.

    Where no line of the learner's is in it, the place of the action that went wrong stands for it. None where that is
    not known either.
    """
    for candidate in reversed(_chain(error)):
        shown = traceback.TracebackException.from_exception(candidate, compact=True)
        shown.__cause__ = shown.__context__ = None
        frames = [frame for frame in shown.stack if not _is_foreign(frame.filename)]
        in_file = isinstance(candidate, SyntaxError) and not _is_foreign(str(candidate.filename))
        place: Place | None = getattr(candidate, "_place_of_action", None)
        if not frames and not in_file and place is not None:
            frames = [place]
        if frames or in_file:
            shown.stack = traceback.StackSummary.from_list(frames)
            return "".join(shown.format(chain=False)).rstrip()
    return None


def place_of_caller() -> Place | None:
    """The line of the learner's that we were called from."""
    frame: FrameType | None = sys._getframe(1)
    while frame is not None and _is_foreign(frame.f_code.co_filename):
        frame = frame.f_back
    if frame is None:
        return None
    return traceback.FrameSummary(frame.f_code.co_filename, frame.f_lineno, frame.f_code.co_name)


def note_place(error: Exception, place: Place | None) -> None:
    """Keep where the action is written that an error comes from."""
    if place is not None and not hasattr(error, "_place_of_action"):
        error._place_of_action = place  # type: ignore[attr-defined]


def _is_foreign(filename: str) -> bool:
    return filename.startswith(("<frozen", "<string>")) or filename.startswith(_FOREIGN)


def _chain(error: BaseException) -> list[BaseException]:
    """The error, what it came from, what that came from."""
    chain: list[BaseException] = []
    current: BaseException | None = error
    while current is not None and current not in chain:
        chain.append(current)
        current = current.__cause__ or (None if current.__suppress_context__ else current.__context__)
    return chain
