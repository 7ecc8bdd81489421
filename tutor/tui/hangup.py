"""A terminal that is gone: its window was closed. The app still has to save, and to end what it has started."""

from __future__ import annotations

import errno
import io
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer


class _Output(io.FileIO):
    """Discards what a closed terminal refuses: Textual's writer thread would die, and its waiters would hang."""

    def write(self, data: ReadableBuffer, /) -> int:
        try:
            return super().write(data)
        except OSError as error:
            if error.errno != errno.EIO:
                raise
            return memoryview(data).nbytes


def prepare() -> None:
    """Have Textual, which draws on `sys.__stderr__`, survive it. Call it before an app is made."""
    if sys.__stderr__ is not None and sys.__stderr__.isatty():
        output = io.BufferedWriter(_Output(sys.__stderr__.fileno(), "w", closefd=False))
        sys.__stderr__ = io.TextIOWrapper(output, sys.__stderr__.encoding, sys.__stderr__.errors)  # type: ignore[misc]
