"""The ROS log folder of a learner's process: kept small while it runs and, in a check, removed afterwards."""

from __future__ import annotations

import asyncio
import contextlib
import heapq
import itertools
import os
import stat
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from uuid import uuid4

from tutor import private_folders

MAX_BYTES = 16_000_000
"""Disk usage above which the log files of a check are truncated. Nobody reads them."""

MAX_APP_BYTES = 256_000_000
"""The same limit for all nodes that the app has run, whose log files people may want to read."""

CHECK_INTERVAL_S = 0.2
APP_INTERVAL_S = 1.0
"""How often the app looks, whose limit leaves more room: with many log folders, a look takes some milliseconds."""

MAX_ENTRIES, MAX_OPENED = 10_000, 100

_FOLDER_FLAGS = os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC
_FILE_FLAGS = os.O_WRONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC


@contextmanager
def temporary_log_folder(parent: Path | None = None) -> Iterator[Path]:
    """Create a log folder, keep it small, and remove it on exit, whatever the processes have done to it.

    `parent`: where; by default, among our private folders. Those processes must have ended on exit. Needs a running
    event loop.
    """
    loop = asyncio.get_running_loop()
    path, folder = private_folders.create("check") if parent is None else _create_in(parent)

    # The descriptor stays valid even if the path is replaced.
    next_check = loop.call_later(CHECK_INTERVAL_S, lambda: check())

    def check() -> None:
        nonlocal next_check
        keep_small(folder)
        next_check = loop.call_later(CHECK_INTERVAL_S, check)

    try:
        yield path
    finally:
        next_check.cancel()
        _remove(folder, path)
        os.close(folder)


async def keep_small_until_cancelled(path: Path, max_bytes: int = MAX_APP_BYTES) -> None:
    """Keep the log files in a folder small until cancelled. The folder need not exist yet."""
    while True:
        with contextlib.suppress(OSError):
            folder = os.open(path, _FOLDER_FLAGS)
            try:
                keep_small(folder, max_bytes)
            finally:
                os.close(folder)
        await asyncio.sleep(APP_INTERVAL_S)


def keep_small(folder: int, max_bytes: int = MAX_BYTES) -> None:
    """Truncate the log files in an open folder and its direct subfolders if they use more than `max_bytes` on disk."""
    with contextlib.ExitStack() as opened, contextlib.suppress(OSError):
        folders = [folder, *_open_all(folder, _largest(folder, folders=True), _FOLDER_FLAGS, opened)]
        logs = [(log_folder, _largest(log_folder)) for log_folder in folders]
        if _disk_bytes(blocks for _, found in logs for blocks, _ in found) <= max_bytes:
            return  # the usual case: no file is opened
        files = [file for log_folder, found in logs for file in _open_all(log_folder, found, _FILE_FLAGS, opened)]
        if _disk_bytes(os.fstat(file).st_blocks for file in files) > max_bytes:
            for file in files:
                os.ftruncate(file, 0)  # loggers open it for appending, so they continue at the new end


def _create_in(parent: Path) -> tuple[Path, int]:
    path = Path(tempfile.mkdtemp(dir=parent))
    return path, os.open(path, _FOLDER_FLAGS)


def _disk_bytes(blocks: Iterable[int]) -> int:
    return 512 * sum(blocks)


def _largest(folder: int, *, folders: bool = False) -> list[tuple[int, str]]:
    """Return (disk blocks, name) of the largest log files, or subfolders, of an open folder."""
    with os.scandir(folder) as entries:
        found = [
            (_blocks(entry), entry.name)
            for entry in itertools.islice(entries, MAX_ENTRIES)
            if entry.is_dir(follow_symlinks=False) == folders and (folders or entry.name.endswith(".log"))
        ]
    return heapq.nlargest(MAX_OPENED, found)


def _open_all(folder: int, found: Iterable[tuple[int, str]], flags: int, opened: contextlib.ExitStack) -> Iterator[int]:
    """Open the entries found in a folder, skipping symbolic links and files with further hard links."""
    for _, name in found:
        with contextlib.suppress(OSError):
            handle = os.open(name, flags, dir_fd=folder)
            opened.callback(os.close, handle)
            status = os.fstat(handle)
            if flags == _FOLDER_FLAGS or (stat.S_ISREG(status.st_mode) and status.st_nlink == 1):
                yield handle


def _blocks(entry: os.DirEntry[str]) -> int:
    try:
        return entry.stat(follow_symlinks=False).st_blocks
    except OSError:
        return 0


def _remove(folder: int, path: Path) -> None:
    """Remove the folder, even if it was moved, and whatever has taken its place."""
    place = os.readlink(f"/proc/self/fd/{folder}")
    _empty(folder)
    with contextlib.suppress(OSError):
        os.rmdir(place)
    with contextlib.suppress(OSError):
        path.unlink()
    with contextlib.suppress(OSError):
        other = os.open(path, _FOLDER_FLAGS)
        _empty(other)
        os.close(other)
        path.rmdir()


def _empty(folder: int) -> None:
    """Remove the contents of an open folder. Nested folders are moved up level by level, so any depth works."""
    before: set[str] = set()
    while True:
        with contextlib.suppress(OSError):
            os.fchmod(folder, 0o700)
        names = set(os.listdir(folder))
        if names == before:  # nothing left, or nothing that can be removed
            return
        before = names
        for name in names:
            with contextlib.suppress(OSError):
                _remove_one(name, folder)


def _remove_one(name: str, folder: int) -> None:
    if not stat.S_ISDIR(os.stat(name, dir_fd=folder, follow_symlinks=False).st_mode):
        os.unlink(name, dir_fd=folder)
        return
    os.chmod(name, 0o700, dir_fd=folder)
    inner = os.open(name, _FOLDER_FLAGS, dir_fd=folder)
    try:
        for entry in os.listdir(inner):
            if stat.S_ISDIR(os.stat(entry, dir_fd=inner, follow_symlinks=False).st_mode):
                os.chmod(entry, 0o700, dir_fd=inner)
                os.rename(entry, uuid4().hex, src_dir_fd=inner, dst_dir_fd=folder)
            else:
                os.unlink(entry, dir_fd=inner)
    finally:
        os.close(inner)
    os.rmdir(name, dir_fd=folder)
