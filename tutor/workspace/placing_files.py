"""Writes several files: all of them or none, and never over a learner's work."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from tutor.errors import StorageError, WorkspaceError


@dataclass(frozen=True, slots=True)
class Placed:
    """The result: files written, files that already had the right content, and the backups of replaced files."""

    written: tuple[Path, ...]
    already_there: tuple[Path, ...]
    backups: tuple[Path, ...]


def place_files(files: Mapping[Path, bytes], *, force: bool) -> Placed:
    """Write each content to its path, creating folders as needed.

    If an existing file differs, nothing at all is written and WorkspaceError is raised; with `force`, the file is kept
    as `name.~1~`, `name.~2~`, ... beside the new one. Raises StorageError after undoing all changes.
    """
    unchanged = tuple(path for path, content in files.items() if os.path.lexists(path) and _has_content(path, content))
    missing = {path: content for path, content in files.items() if path not in unchanged}
    in_the_way = [path for path in missing if os.path.lexists(path)]
    if in_the_way and not force:
        raise WorkspaceError(_conflict_message(in_the_way))
    for path in missing:
        _check_folder(path.parent)

    undo: list[Callable[[], object]] = []
    backups: list[Path] = []
    try:
        for path, content in missing.items():
            path.parent.mkdir(parents=True, exist_ok=True)
            if path in in_the_way:
                backup = free_name(path)
                path.rename(backup)
                backups.append(backup)
                undo.append(partial(backup.replace, path))
            with path.open("xb") as file:  # "x": never overwrite a file that has appeared in the meantime
                undo.append(partial(path.unlink, missing_ok=True))
                file.write(content)
    except OSError as error:
        for step in reversed(undo):
            step()
        raise StorageError.of(f"write {path}", error) from error
    return Placed(tuple(missing), unchanged, tuple(backups))


def _has_content(path: Path, content: bytes) -> bool:
    if path.is_dir():
        raise WorkspaceError(f"{path} is a folder, but a file of this name belongs there: move it away")
    try:
        return path.read_bytes() == content
    except OSError:
        return False  # unreadable, or a dangling link: not ours to overwrite


def _conflict_message(paths: list[Path]) -> str:
    names = " and ".join(str(path) for path in paths)
    if len(paths) == 1:
        return f"{names} already exists and is not the skeleton: go on with it, or use --force (a backup is kept)"
    return f"{names} already exist and are not the skeleton: go on with them, or use --force (backups are kept)"


def _check_folder(folder: Path) -> None:
    """Fail before anything is written, if it is already clear that `folder` cannot be created or written to."""
    nearest = next(parent for parent in (folder, *folder.parents) if os.path.lexists(parent))
    if not nearest.is_dir():
        raise WorkspaceError(f"{nearest} is a file, but a folder of this name is needed: move it away")
    if not os.access(nearest, os.W_OK | os.X_OK):
        raise StorageError(f"cannot write to {nearest}: permission denied")


def free_name(path: Path) -> Path:
    """Return the next free name for a backup of `path`: `name.~1~`, `name.~2~`, ..."""
    number = 1
    while os.path.lexists(backup := path.with_name(f"{path.name}.~{number}~")):
        number += 1
    return backup
