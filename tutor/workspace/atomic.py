"""Writes files atomically: a reader sees either the old content or the new one, never a part of it."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from tutor.errors import StorageError


def write_atomically(path: Path, text: str) -> None:
    """Write `text` as UTF-8 to a temporary file beside `path`, flush it to disk, and rename it to `path`.

    If `path` is not a regular file (but a terminal or a pipe), it is written to directly. If it is a symbolic link, its
    target is replaced. Raises StorageError.
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
        # With O_NONBLOCK, opening a pipe without a reader fails instead of blocking until there is one.
        fd = os.open(path, os.O_WRONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
        os.set_blocking(fd, True)
        with os.fdopen(fd, "wb") as file:
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
    """Flush the directory, so that the rename survives a power failure."""
    fd = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(fd)
    finally:
        os.close(fd)
