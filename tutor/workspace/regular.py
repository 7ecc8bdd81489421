"""Reading a file that anybody may have put there: only a regular one, and only so much of it."""

from __future__ import annotations

import os
import stat
from pathlib import Path


def read_regular(path: Path | str, most: int) -> bytes | None:
    """The bytes of a file; None for anything but a regular file (a FIFO, a device), and for more than `most` bytes.

    Never waits for a writer. Raises OSError where it cannot be opened.
    """
    handle = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
    with os.fdopen(handle, "rb", closefd=True) as file:
        if not stat.S_ISREG(os.fstat(handle).st_mode):
            return None
        data = file.read(most + 1)
        return data if len(data) <= most else None


def read_text(path: Path, most: int = 16_000_000) -> str:
    """The text of one of our files. Raises OSError, and ValueError where it is no text file."""
    data = read_regular(path, most)
    if data is None:
        raise ValueError("it is damaged")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise ValueError("it is damaged") from error
