"""Packs a course into one file, and unpacks such a file where it can be used."""

from __future__ import annotations

import hashlib
import os
import shutil
import tempfile
import zipfile
from collections.abc import Iterator
from pathlib import Path

from tutor import private_folders
from tutor.errors import StorageError, UsageError

SUFFIX = ".course.zip"
MAX_BYTES = 64 << 20
"""Limit on the files of a packed course."""

_FOLDERS = ("lessons", "checks", "submissions")
_EPOCH = (1980, 1, 1, 0, 0, 0)
"""The time of change of every file in the archive, so that the same course makes the same file."""


def pack(folder: Path, file: Path) -> int:
    """Write the course in `folder` to `file`, replacing it; return how many files it has. Raises StorageError."""
    paths = list(_files(folder))
    try:
        with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
            for path in paths:
                archive.writestr(zipfile.ZipInfo(str(path.relative_to(folder)), _EPOCH), path.read_bytes())
    except OSError as error:
        raise StorageError.of(f"write {file}", error) from error
    return len(paths)


def _files(folder: Path) -> Iterator[Path]:
    yield from sorted(path for path in folder.iterdir() if path.is_file() and not path.name.startswith("."))
    for name in _FOLDERS:
        for path in sorted((folder / name).rglob("*")):
            hidden = any(part.startswith(".") or part == "__pycache__" for part in path.relative_to(folder).parts)
            if path.is_file() and not hidden:
                yield path


def unpacked(file: Path) -> Path:
    """Return a folder with the course packed in `file`, which is unpacked once. Raises UsageError and StorageError."""
    try:
        digest = hashlib.sha256(file.read_bytes()).hexdigest()[:16]
        folder = private_folders.base() / "courses" / digest
        if not folder.is_dir():
            _unpack(file, folder)
    except OSError as error:
        raise StorageError.of(f"unpack {file}", error) from error
    return folder


def _unpack(file: Path, folder: Path) -> None:
    folder.parent.mkdir(mode=0o700, exist_ok=True)
    scratch = Path(tempfile.mkdtemp(prefix="unpacking-", dir=folder.parent))
    try:
        with zipfile.ZipFile(file) as archive:
            if sum(member.file_size for member in archive.infolist()) > MAX_BYTES:
                raise UsageError(f"--lessons {file}: it is larger than {MAX_BYTES >> 20} MB")
            archive.extractall(scratch)  # names that lead out of the folder are made to stay in it
        if not (scratch / "lessons").is_dir():
            raise UsageError(f"--lessons {file}: it has no lessons/ folder, so it is not a course")
        try:
            os.rename(scratch, folder)
        except OSError:
            if not folder.is_dir():  # else another process was faster
                raise
    except (zipfile.BadZipFile, EOFError, NotImplementedError, RuntimeError) as error:
        raise UsageError(f"--lessons {file}: it is not a packed course; `author pack` makes one (*{SUFFIX})") from error
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
