"""What learners handed in: folders, files and archives, opened and listed."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tutor.errors import StorageError, UsageError
from tutor.grade.archives import ONE_SUBMISSION, WHOLE_CLASS, BadArchive, Limits, is_archive, is_skipped, stem, unpack
from tutor.grade.learners import Learner
from tutor.grade.submission_files import is_own_file

_MAX_DEPTH, _MAX_FOLDERS = 6, 5000
_MAX_NESTED, _NESTED_DEPTH = 10, 2


@dataclass(frozen=True, slots=True)
class HandedIn:
    """What one learner handed in: a folder, or single files that were renamed by a system (`files`, by their own name).

    `names`: the names of the files in each folder, by its path relative to `folder`. `exercise`: the only one it is
    for; empty if it may be for any. `problem`: why there is nothing to judge in it. `fault`: why it cannot be read on
    this machine, which is not the learner's problem.
    """

    learner: Learner
    folder: Path | None = None
    files: Mapping[str, Path] = field(default_factory=dict)
    exercise: str = ""
    names: Mapping[str, Sequence[str]] = field(default_factory=dict)
    problem: str = ""
    fault: str = ""


class Opener:
    """Opens what learners handed in. `scratch`: an empty folder for what archives hold."""

    def __init__(self, scratch: Path) -> None:
        self._scratch = scratch
        self._count = 0

    def open_class(self, path: Path) -> tuple[Path, str]:
        """Return the folder of a class, and its name. `path` is that folder or an archive. Raises UsageError."""
        if path.is_dir():
            return path, path.resolve().name
        if not is_archive(path):
            raise UsageError(
                f"{path} is neither a folder nor an archive (zip or tar)" if path.exists() else f"there is no {path}"
            )
        try:
            return self._unpack(path, WHOLE_CLASS), stem(path)
        except BadArchive as error:
            raise UsageError(f"{path} cannot be unpacked: {error}") from error
        except OSError as error:
            raise StorageError.of(f"unpack {path}", error) from error

    def open(self, learner: Learner, path: Path, *, name: str = "", exercise: str = "") -> Iterator[HandedIn]:
        """Yield what is in a folder, a file or an archive, and in the archives in it.

        `name`: the learner's own name for a file.
        """
        name = name or path.name
        if not path.exists():
            yield HandedIn(learner, exercise=exercise, problem=f"{name} is a link that leads nowhere")
        elif path.is_dir():
            yield from self._open_folder(learner, path, exercise, _NESTED_DEPTH)
        elif is_archive(path):
            yield from self._open_archive(learner, path, name, exercise, _NESTED_DEPTH)
        else:
            yield HandedIn(learner, files={name: path}, exercise=exercise, names={".": [name]})

    def _open_archive(self, learner: Learner, path: Path, name: str, exercise: str, depth: int) -> Iterator[HandedIn]:
        try:
            folder = self._unpack(path, ONE_SUBMISSION)
        except BadArchive as error:
            yield HandedIn(learner, exercise=exercise, problem=f"{name} cannot be unpacked: {error}")
        except OSError as error:
            fault = f"{name} cannot be unpacked here: {error.strerror}"
            yield HandedIn(learner, exercise=exercise, fault=fault)
        else:
            yield from self._open_folder(learner, folder, exercise, depth)

    def _open_folder(self, learner: Learner, folder: Path, exercise: str, depth: int) -> Iterator[HandedIn]:
        try:
            names = _list(folder)
        except OSError as error:
            fault = f"{error.filename} cannot be read: {error.strerror}"
            yield HandedIn(learner, exercise=exercise, fault=fault)
            return
        yield HandedIn(learner, folder, exercise=exercise, names=names)
        if depth == 0:
            return
        files = (folder / below / name for below, inside in names.items() if below.count("/") < 1 for name in inside)
        archives = [path for path in files if is_archive(path) and is_own_file(path, folder)]
        for path in archives[:_MAX_NESTED]:
            yield from self._open_archive(learner, path, path.name, exercise, depth - 1)

    def _unpack(self, archive: Path, limits: Limits) -> Path:
        self._count += 1
        folder = self._scratch / str(self._count)
        folder.mkdir()
        try:
            unpack(archive, folder, limits)
        except BaseException:
            shutil.rmtree(folder, ignore_errors=True)
            raise
        return folder


def _list(folder: Path) -> dict[str, Sequence[str]]:
    """Return the names of the files in each folder, by its relative path. Raises OSError."""

    def fail(error: OSError) -> None:
        raise error

    names: dict[str, Sequence[str]] = {}
    for parent, folders, files in os.walk(folder, onerror=fail):
        relative = Path(parent).relative_to(folder)
        names[relative.as_posix()] = sorted(name for name in files if not name.startswith("."))
        deep = len(relative.parts) >= _MAX_DEPTH or len(names) >= _MAX_FOLDERS
        folders[:] = [] if deep else sorted(name for name in folders if not is_skipped(name))
    return names
