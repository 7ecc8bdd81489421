"""The files of a submission, and how they travel to the process that judges it."""

from __future__ import annotations

import os
import stat
import zipfile
from collections.abc import Iterator, Mapping
from hashlib import sha256
from io import BytesIO
from pathlib import Path, PurePath, PurePosixPath

from tutor.grade.archives import MAX_DEPTH, MAX_PATH, ONE_SUBMISSION, Limits, is_skipped, is_source

_EPOCH = (1980, 1, 1, 0, 0, 0)


def pack(files: Mapping[str, Path]) -> tuple[bytes, str]:
    """Pack files, by the name that they have in the archive, and return it with their `digest_of`.

    Equal files make equal bytes. Raises OSError.
    """
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
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(archive.read(entry))
            target.chmod(entry.external_attr >> 16 & 0o777)


def digest_of(files: Mapping[str, Path]) -> str:
    """Return a digest of the names and contents of files. Raises OSError."""
    digest = sha256()
    for name, path in sorted(files.items()):
        digest.update(_line_of(name, path.read_bytes()))
    return digest.hexdigest()


def _line_of(name: str, content: bytes) -> bytes:
    return f"{name!r} {sha256(content).hexdigest()}\n".encode("utf-8", "surrogatepass")


def files_below(folder: Path, submission: Path, limits: Limits = ONE_SUBMISSION) -> dict[str, Path]:
    """Return the files below `folder` of a submission, by relative path; only source files if there are too many.

    Raises OSError.
    """
    every = {
        path.relative_to(folder).as_posix(): path
        for path in _walk(folder)
        if _is_packable(path.relative_to(folder)) and is_own_file(path, submission)
    }
    sizes = {name: path.stat().st_size for name, path in every.items()}
    chosen = _within(sizes, limits)
    if len(chosen) < len(every):
        chosen = _within({name: size for name, size in sizes.items() if is_source(every[name], size)}, limits)
    return {name: every[name] for name in chosen}


def _within(sizes: Mapping[str, int], limits: Limits) -> list[str]:
    """Return the first of these files, by their sizes, that keep to the limits; their folders count as well."""
    names: list[str] = []
    folders: set[PurePosixPath] = set()
    total = 0
    for name, size in sizes.items():
        folders.update(PurePosixPath(name).parents)
        total += size
        if len(names) + len(folders) >= limits.files or total > limits.bytes:
            break
        names.append(name)
    return names


def _walk(folder: Path) -> Iterator[Path]:
    for parent, folders, names in os.walk(folder, onerror=_raise):
        folders[:] = sorted(name for name in folders if not is_skipped(name))
        for name in sorted(names):
            if not name.endswith(".pyc"):
                yield Path(parent, name)


def _raise(error: OSError) -> None:
    raise error


def _is_packable(path: PurePath) -> bool:
    """Whether a relative path is one that any machine can have: its names are Unicode, and it is not too deep."""
    try:
        return len(path.parts) <= MAX_DEPTH and len(str(path).encode()) <= MAX_PATH
    except UnicodeEncodeError:
        return False


def is_own_file(path: Path, submission: Path) -> bool:
    """Whether this is a regular file of the submission's folder, not a link that leads out of it."""
    try:
        return path.is_file() and path.resolve().is_relative_to(submission.resolve())
    except (OSError, RuntimeError):
        return False
