"""Saves a text over a file that others may be changing too: whatever they wrote meanwhile is never lost."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from tutor.errors import StorageError
from tutor.workspace.atomic import write_atomically
from tutor.workspace.placing_files import free_name

LARGEST = 1 << 20
"""No file larger than this is opened for editing, in bytes."""


@dataclass(frozen=True, slots=True)
class Saved:
    """What a save did: `done`, or what is on the disk instead (None: no file); `backup` holds what was replaced."""

    done: bool
    found: str | None = None
    backup: Path | None = None


def read_source(path: Path) -> str | None:
    """The text of a file, or None where it is not there. Raises StorageError where it cannot be read as UTF-8."""
    try:
        with path.open("rb") as file:
            content = file.read(LARGEST + 1)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise StorageError.of(f"read {path}", error) from error
    if len(content) > LARGEST:
        raise StorageError(f"{path} is larger than {LARGEST >> 20} MiB: open it in your own editor")
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        raise StorageError(f"{path} is not UTF-8: open it in your own editor") from error


def overwrite_file(path: Path, text: str, expected: str | None) -> Saved:
    """Write `text` to `path` if it still holds `expected` (None: if it is not there). Raises StorageError.

    What somebody wrote between the look and the write is kept as `name.~1~`, `name.~2~`, ...
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
    except OSError:  # a file system without hard links: the look above is all there is
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
    """Keep `text` beside `path`, as `name.~1~`, `name.~2~`, ...; where it is. Raises StorageError."""
    _make_folder(path.parent)
    backup = free_name(path)
    write_atomically(backup, text)
    return backup


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StorageError.of(f"make {folder}", error) from error
