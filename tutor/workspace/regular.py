"""Reads files that anyone may have put there: only regular ones, and only up to a size limit."""

from __future__ import annotations

import os
import stat
from pathlib import Path


def read_regular(path: Path | str, max_bytes: int) -> bytes | None:
    """Return the bytes of a file; None if it is not a regular file (a FIFO, a device) or larger than `max_bytes` bytes.

    Never blocks. Raises OSError if it cannot be opened.
    """
    fd = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
    with os.fdopen(fd, "rb") as file:
        if not stat.S_ISREG(os.fstat(fd).st_mode):
            return None
        data = file.read(max_bytes + 1)
        return data if len(data) <= max_bytes else None


def read_text(path: Path, max_bytes: int = 16_000_000) -> str:
    """Read one of our files. Raises OSError, or ValueError if it is not UTF-8 text of at most `max_bytes` bytes."""
    data = read_regular(path, max_bytes)
    if data is None:
        raise ValueError("it is damaged")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise ValueError("it is damaged") from error
