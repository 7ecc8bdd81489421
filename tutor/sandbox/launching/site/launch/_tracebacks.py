"""The part of a traceback that lies in the learner's own files."""

from __future__ import annotations

import os.path
import sysconfig
import traceback

_OURS = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
_FOREIGN = (
    _OURS,
    sysconfig.get_path("stdlib"),
    sysconfig.get_path("purelib"),
    sysconfig.get_path("platlib"),
    "<frozen",
)


def of_learner(error: BaseException) -> str | None:
    """The traceback of what first went wrong, without the frames of others; None where no line is the learner's."""
    for candidate in reversed(_chain(error)):
        told = traceback.TracebackException.from_exception(candidate, compact=True)
        told.__cause__ = told.__context__ = None
        frames = [frame for frame in told.stack if not _is_foreign(frame.filename)]
        told.stack = traceback.StackSummary.from_list(frames)
        syntax_error = isinstance(candidate, SyntaxError) and candidate.filename is not None
        if frames or (syntax_error and not _is_foreign(str(candidate.filename))):  # type: ignore[attr-defined]
            return "".join(told.format(chain=False)).rstrip()
    return None


def _is_foreign(filename: str) -> bool:
    return filename.startswith("<frozen") or any(
        filename == folder or filename.startswith(folder + os.sep) for folder in _FOREIGN
    )


def _chain(error: BaseException) -> list[BaseException]:
    """The error, what it came from, what that came from."""
    chain: list[BaseException] = []
    current: BaseException | None = error
    while current is not None and current not in chain:
        chain.append(current)
        current = current.__cause__ or (None if current.__suppress_context__ else current.__context__)
    return chain
