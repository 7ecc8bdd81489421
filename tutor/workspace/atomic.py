"""Writes a file so that a reader sees the old content or the new one, never a part of it."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from tutor.errors import StorageError


def write_atomically(path: Path, text: str) -> None:
    """Write `text` as UTF-8 to a temporary file beside `path`, flush it to the disk, and rename it to `path`.

    Something at `path` that is not a regular file (a terminal, a pipe) is written to directly; where it is a symbolic
    link, what it points to is replaced. Raises StorageError.
    """
    try:
        _write(Path(os.path.realpath(path)), text.encode("utf-8", "replace"))
    except OSError as error:
        raise StorageError.of(f"write {path}", error) from error


def _write(path: Path, content: bytes) -> None:
    try:
        mode = path.stat().st_mode
    except FileNotFoundError:
        mode = None
    if mode is not None and not stat.S_ISREG(mode):
        # A pipe that nobody reads refuses to be opened, in place of waiting for a reader.
        handle = os.open(path, os.O_WRONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
        os.set_blocking(handle, True)
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        return
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        with temporary.open("wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        if mode is not None:
            temporary.chmod(stat.S_IMODE(mode))
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    _flush_folder(path.parent)


def _flush_folder(folder: Path) -> None:
    """Make the rename itself survive a power cut."""
    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
