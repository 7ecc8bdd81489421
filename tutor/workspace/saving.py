"""Saves edits to a file that other programs may change too, without ever losing what they wrote in the meantime."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from tutor.errors import StorageError
from tutor.workspace.atomic import write_atomically
from tutor.workspace.placing_files import free_name

MAX_EDIT_BYTES = 1 << 20
"""Maximum size of a file that is opened for editing, in bytes."""


@dataclass(frozen=True, slots=True)
class Saved:
    """The result of a save. If not `done`, `found` is the file's content on disk (None: no file).

    `backup` is the backup of another program's changes that were replaced.
    """

    done: bool
    found: str | None = None
    backup: Path | None = None


def read_source(path: Path) -> str | None:
    """Read a text file; return None if it does not exist. Raises StorageError if it cannot be read as UTF-8."""
    try:
        with path.open("rb") as file:
            content = file.read(MAX_EDIT_BYTES + 1)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise StorageError.of(f"read {path}", error) from error
    if len(content) > MAX_EDIT_BYTES:
        raise StorageError(f"{path} is larger than {MAX_EDIT_BYTES >> 20} MiB: open it in your own editor")
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        raise StorageError(f"{path} is not UTF-8: open it in your own editor") from error


def overwrite_file(path: Path, text: str, expected: str | None) -> Saved:
    """Write `text` to `path` if it still contains `expected` (None: if it does not exist). Raises StorageError.

    Changes that another program makes between our read and our write are kept as `name.~1~`, `name.~2~`, ...
    """
    if (found := read_source(path)) != expected:
        return Saved(False, found)
    if found is None:
        _make_folder(path.parent)
        write_atomically(path, text)
        return Saved(True)
    before = path.with_name(f".{path.name}.{os.getpid()}.before")
    try:
        before.unlink(missing_ok=True)
        os.link(path, before)
    except OSError:  # a file system without hard links: the comparison above has to suffice
        write_atomically(path, text)
        return Saved(True)
    try:
        write_atomically(path, text)
        if read_source(before) == expected:
            return Saved(True)
        backup = free_name(path)
        os.link(before, backup)
        return Saved(True, backup=backup)
    except OSError as error:
        raise StorageError.of(f"write {path}", error) from error
    finally:
        before.unlink(missing_ok=True)


def back_up_file(path: Path, text: str) -> Path:
    """Save `text` beside `path` as `name.~1~`, `name.~2~`, ... and return that path. Raises StorageError."""
    _make_folder(path.parent)
    backup = free_name(path)
    write_atomically(backup, text)
    return backup


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StorageError.of(f"make {folder}", error) from error
