"""Unpacks archives that learners handed in, and packs the files of a submission for the process that judges it."""

from __future__ import annotations

import os
import stat
import tarfile
import zipfile
from collections.abc import Iterator, Mapping
from hashlib import sha256
from io import BytesIO
from pathlib import Path, PurePosixPath

MAX_FILES, MAX_BYTES = 2000, 64 << 20
"""Limits on what is taken from one submission, as for isolated checks."""

_SUFFIXES = (".zip", ".tar", ".tar.gz", ".tgz", ".tar.xz", ".tar.bz2")
_SKIPPED = frozenset(
    ("__pycache__", "__MACOSX", "build", "install", "log", "node_modules", "venv", "env", "site-packages")
)
_SOURCES = frozenset(
    (".py", ".xml", ".yaml", ".yml", ".json", ".toml", ".cfg", ".txt", ".md", ".msg", ".srv", ".action", ".launch", "")
)
_EPOCH = (1980, 1, 1, 0, 0, 0)


class BadArchive(Exception):
    """An archive cannot be unpacked; the message says why, in a few words."""


def is_archive(path: Path) -> bool:
    """Whether a file is an archive, judging by its name."""
    return path.name.lower().endswith(_SUFFIXES) and path.is_file()


def stem(path: Path) -> str:
    """Return the name of an archive without its suffix, or that of a file without its own."""
    suffix = next((suffix for suffix in sorted(_SUFFIXES, key=len)[::-1] if path.name.lower().endswith(suffix)), "")
    return path.name[: len(path.name) - len(suffix)] if suffix else path.stem


def is_skipped(name: str) -> bool:
    """Whether a folder holds no source code: hidden, built, or a virtual environment."""
    return name.startswith(".") or name in _SKIPPED


def unpack(archive: Path, folder: Path) -> None:
    """Unpack regular files below `folder`; links, devices and names that lead out of it are left out.

    Raises BadArchive for one that is damaged, encrypted or too large.
    """
    try:
        if archive.name.lower().endswith(".zip"):
            _unpack_zip(archive, folder)
        else:
            _unpack_tar(archive, folder)
    except (zipfile.BadZipFile, tarfile.TarError, EOFError, NotImplementedError, ValueError) as error:
        raise BadArchive("it is damaged, or not an archive of this kind") from error
    except RuntimeError as error:  # of zipfile, for a password
        raise BadArchive("it is encrypted") from error
    except OSError as error:
        raise BadArchive(error.strerror or "it cannot be unpacked") from error


def _unpack_zip(archive: Path, folder: Path) -> None:
    budget = _Budget()
    with zipfile.ZipFile(archive) as content:
        for entry in content.infolist():
            target = _target(entry.filename, folder)
            mode = entry.external_attr >> 16
            if entry.is_dir() or target is None or (mode and stat.S_IFMT(mode) not in (0, stat.S_IFREG)):
                continue
            with content.open(entry) as source:
                _write(target, budget.read(source))


def _unpack_tar(archive: Path, folder: Path) -> None:
    budget = _Budget()
    with tarfile.open(archive) as content:
        for entry in content:
            target = _target(entry.name, folder)
            source = content.extractfile(entry) if entry.isfile() and target is not None else None
            if source is not None and target is not None:
                _write(target, budget.read(source))


class _Budget:
    """What may still be unpacked: the sizes that an archive states are not believed."""

    def __init__(self) -> None:
        self._files = MAX_FILES
        self._bytes = MAX_BYTES

    def read(self, source: object) -> bytes:
        content: bytes = source.read(self._bytes + 1)  # type: ignore[attr-defined]
        self._files -= 1
        self._bytes -= len(content)
        if self._files < 0 or self._bytes < 0:
            raise BadArchive(f"it is too large: more than {MAX_FILES} files or {MAX_BYTES >> 20} MB")
        return content


def _target(name: str, folder: Path) -> Path | None:
    parts = PurePosixPath(name.replace("\\", "/")).parts
    if not parts or parts[0] == "/" or ".." in parts or any(is_skipped(part) for part in parts[:-1]):
        return None
    return folder.joinpath(*parts)


def _write(target: Path, content: bytes) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(content)


# --- packing ---


def pack(files: Mapping[str, Path]) -> tuple[bytes, str]:
    """Pack files, by the name that they have in the archive, and return it with their `digest_of`. Raises OSError."""
    buffer, digest = BytesIO(), sha256()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, path in sorted(files.items()):
            entry = zipfile.ZipInfo(name, _EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (stat.S_IFREG | (0o755 if os.access(path, os.X_OK) else 0o644)) << 16
            content = path.read_bytes()
            archive.writestr(entry, content)
            digest.update(_line_of(name, content))
    return buffer.getvalue(), digest.hexdigest()


def unpack_packed(packed: bytes, folder: Path) -> None:
    """Unpack what `pack` made below `folder`. Raises OSError."""
    with zipfile.ZipFile(BytesIO(packed)) as archive:
        for entry in archive.infolist():
            target = folder.joinpath(*PurePosixPath(entry.filename).parts)
            _write(target, archive.read(entry))
            target.chmod(entry.external_attr >> 16 & 0o777)


def digest_of(files: Mapping[str, Path]) -> str:
    """Return a digest of the names and contents of files. Raises OSError."""
    digest = sha256()
    for name, path in sorted(files.items()):
        digest.update(_line_of(name, path.read_bytes()))
    return digest.hexdigest()


def _line_of(name: str, content: bytes) -> bytes:
    return f"{name!r} {sha256(content).hexdigest()}\n".encode("utf-8", "surrogatepass")


def files_below(folder: Path, submission: Path) -> dict[str, Path]:
    """Return the files below `folder` of a submission, by relative path; only source files if there are too many."""
    every = {path.relative_to(folder).as_posix(): path for path in _walk(folder) if is_own_file(path, submission)}
    size = sum(path.stat().st_size for path in every.values())
    if len(every) <= MAX_FILES and size <= MAX_BYTES:
        return every
    sources = {name: path for name, path in every.items() if path.suffix in _SOURCES and path.stat().st_size < 1 << 20}
    return dict(list(sources.items())[:MAX_FILES])


def _walk(folder: Path) -> Iterator[Path]:
    for parent, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if not is_skipped(name))
        for name in sorted(names):
            if not name.endswith(".pyc"):
                yield Path(parent, name)


def is_own_file(path: Path, submission: Path) -> bool:
    """Whether this is a regular file of the submission's folder, not a link that leads out of it."""
    try:
        return path.is_file() and path.resolve().is_relative_to(submission.resolve())
    except (OSError, RuntimeError):
        return False
