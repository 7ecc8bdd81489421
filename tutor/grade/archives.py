"""Unpacks archives that learners handed in."""

from __future__ import annotations

import errno
import lzma
import stat
import struct
import tarfile
import zipfile
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path, PurePath, PurePosixPath
from typing import IO


@dataclass(frozen=True, slots=True)
class Limits:
    """How much is taken from an archive or a folder: this many files and folders, and bytes.

    `all_or_nothing`: beyond that it is refused, rather than taken without its large files that are no source code.
    """

    files: int
    bytes: int
    all_or_nothing: bool = False


ONE_SUBMISSION = Limits(1900, 60 << 20)
"""A little less than isolated checks allow."""

WHOLE_CLASS = Limits(200_000, 8 << 30, all_or_nothing=True)

_SOURCE_BYTES = 1 << 20
_PART_BYTES = 1 << 20
_SOURCES = frozenset(
    (".py", ".xml", ".yaml", ".yml", ".json", ".toml", ".cfg", ".txt", ".md", ".msg", ".srv", ".action", ".launch", "")
)
_SUFFIXES = (".tar.gz", ".tar.xz", ".tar.bz2", ".zip", ".tar", ".tgz")
_OTHER_SUFFIXES = (".rar", ".7z", ".gz", ".xz", ".bz2", ".zst")
_SKIPPED = frozenset(
    ("__pycache__", "__MACOSX", "build", "install", "log", "node_modules", "venv", "env", "site-packages")
)
MAX_DEPTH, MAX_PATH = 30, 1000
"""What is deeper, or has a longer path, is left out."""

_MAX_LEFT_OUT = 16
"""Times the limits: what an archive may hold besides, which takes time to get past."""

_NAME_ERRORS = (errno.ENAMETOOLONG, errno.EEXIST, errno.ENOTDIR, errno.EISDIR, errno.EINVAL, errno.EILSEQ)


class BadArchive(Exception):
    """An archive cannot be unpacked; the message says why, in a few words."""


def is_archive(path: Path) -> bool:
    """Whether a file is an archive, judging by its name; not all can be unpacked."""
    return path.name.lower().endswith((*_SUFFIXES, *_OTHER_SUFFIXES)) and path.is_file()


def stem(path: Path) -> str:
    """Return the name of an archive without its suffix, or that of a file without its own."""
    suffix = next((suffix for suffix in _SUFFIXES if path.name.lower().endswith(suffix)), "")
    return path.name[: len(path.name) - len(suffix)] if suffix else path.stem


def is_skipped(name: str) -> bool:
    """Whether a folder holds no source code: hidden, built, or a virtual environment."""
    return name.startswith(".") or name in _SKIPPED


# --- unpacking ---


def unpack(archive: Path, folder: Path, limits: Limits = ONE_SUBMISSION) -> None:
    """Unpack regular files below `folder`; links, devices and names that lead out of it are left out.

    So are large files that are no source code once there are too many. Raises BadArchive for one that is damaged,
    encrypted or too large, and OSError if this machine cannot read or write.
    """
    name = archive.name.lower()
    if not name.endswith(_SUFFIXES):
        raise BadArchive("it is neither a zip nor a tar file")
    try:
        if name.endswith(".zip"):
            _unpack_zip(archive, folder, _Budget(limits))
        else:
            _unpack_tar(archive, folder, _Budget(limits))
    except (zipfile.BadZipFile, tarfile.TarError, zlib.error, lzma.LZMAError, struct.error, EOFError) as error:
        raise BadArchive("it is damaged, or not an archive of this kind") from error
    except (NotImplementedError, RecursionError, ValueError) as error:
        raise BadArchive("it is damaged, or not an archive of this kind") from error
    except RuntimeError as error:  # of zipfile, for a password
        raise BadArchive("it is encrypted") from error
    except OSError as error:
        if error.errno in (None, errno.EINVAL):  # of a decompressor, or for a place before the beginning
            raise BadArchive("it is damaged, or not an archive of this kind") from error
        raise


def _unpack_zip(archive: Path, folder: Path, budget: _Budget) -> None:
    with zipfile.ZipFile(archive) as content:
        for entry in content.infolist():
            budget.pass_over(0)
            if stat.S_IFMT(entry.external_attr >> 16) in (0, stat.S_IFREG) and not entry.is_dir():
                _take(_Entry(entry.filename, entry.file_size, partial(content.open, entry)), folder, budget)


def _unpack_tar(archive: Path, folder: Path, budget: _Budget) -> None:
    with tarfile.open(archive) as content:
        for entry in content:
            budget.pass_over(entry.size)
            if entry.isfile():
                _take(_Entry(entry.name, entry.size, partial(content.extractfile, entry)), folder, budget)


@dataclass(frozen=True, slots=True)
class _Entry:
    """A regular file in an archive. `size` is what the archive says of it."""

    name: str
    size: int
    open: Callable[[], IO[bytes] | None]


class _Budget:
    """What may still be unpacked. The sizes that an archive states are not believed."""

    def __init__(self, limits: Limits) -> None:
        self._limits = limits
        self._left_out = Limits(_MAX_LEFT_OUT * limits.files, _MAX_LEFT_OUT * limits.bytes)
        self._sources = self._others = limits

    def pass_over(self, size: int) -> None:
        """Count an entry that must be read to get to the next one. Raises BadArchive for too many."""
        if size < 0:
            raise ValueError("a size below 0")
        self._left_out = _without(self._left_out, size)
        if self._left_out.files < 0 or self._left_out.bytes < 0:
            raise self._too_large()

    def read(self, entry: _Entry) -> Iterator[bytes] | None:
        """Return the content, in parts; None if it is no source code and there is no room for it. Raises BadArchive."""
        wanted = self._limits.all_or_nothing or is_source(PurePosixPath(entry.name), entry.size)
        left = self._sources if wanted else self._others
        if left.files > 0 and left.bytes >= entry.size:
            return self._parts(entry, wanted)
        if wanted:
            raise self._too_large()
        return None

    def _parts(self, entry: _Entry, wanted: bool) -> Iterator[bytes]:
        left = _without(self._sources if wanted else self._others, 0)
        source = entry.open()
        if source is not None:
            with source:
                while part := source.read(_PART_BYTES):
                    left = replace(left, bytes=left.bytes - len(part))
                    if left.bytes < 0:
                        raise self._too_large()
                    yield part
        if wanted:
            self._sources = left
        else:
            self._others = left

    def _too_large(self) -> BadArchive:
        return BadArchive(f"it is too large: more than {self._limits.files} files or {self._limits.bytes >> 20} MB")


def _without(limits: Limits, size: int) -> Limits:
    return replace(limits, files=limits.files - 1, bytes=limits.bytes - size)


def is_source(path: PurePath, size: int) -> bool:
    """Whether a file may be source code: by its suffix, and not too large, in bytes."""
    return path.suffix.lower() in _SOURCES and size <= _SOURCE_BYTES


def _take(entry: _Entry, folder: Path, budget: _Budget) -> None:
    parts = PurePosixPath(entry.name.replace("\\", "/")).parts
    if not parts or parts[0] == "/" or ".." in parts or any(is_skipped(part) for part in parts[:-1]):
        return
    if len(parts) > MAX_DEPTH or len(entry.name) > MAX_PATH:
        return
    content = budget.read(entry)
    if content is None:
        return
    target = folder.joinpath(*parts)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        file = target.open("wb")
    except OSError as error:
        if error.errno in _NAME_ERRORS:  # no such name, or one that stands for a file and for a folder
            return
        raise
    with file:
        file.writelines(content)
