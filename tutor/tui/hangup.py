"""Survives a terminal hangup (the window was closed): the app must still save, and stop what it has started."""

from __future__ import annotations

import errno
import io
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer


class _HangupSafeOutput(io.FileIO):
    """Discards output that a closed terminal refuses: EIO would kill Textual's writer thread and hang its waiters."""

    def write(self, data: ReadableBuffer, /) -> int:
        try:
            return super().write(data)
        except OSError as error:
            if error.errno != errno.EIO:
                raise
            return memoryview(data).nbytes


def prepare() -> None:
    """Make `sys.__stderr__`, on which Textual draws, survive a hangup. Call before creating the app."""
    if sys.__stderr__ is not None and sys.__stderr__.isatty():
        output = io.BufferedWriter(_HangupSafeOutput(sys.__stderr__.fileno(), "w", closefd=False))
        sys.__stderr__ = io.TextIOWrapper(output, sys.__stderr__.encoding, sys.__stderr__.errors)  # type: ignore[misc]
