"""The folder that a learner's process logs into: kept small while it runs; in a check, gone afterwards."""

from __future__ import annotations

import asyncio
import contextlib
import heapq
import itertools
import os
import stat
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from uuid import uuid4

from tutor import private_folders

MOST_BYTES = 16_000_000
"""What the log files may take on the disk in a check, where nobody reads them; they are emptied when it is more."""

MOST_OF_THE_APP = 256_000_000
"""The same for all nodes that the app has run, whose log files people may want to read."""

LOOK_EVERY_S = 0.2
MOST_ENTRIES, MOST_OPENED = 10_000, 100

_FOLDER = os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC
_FILE = os.O_WRONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC


@contextmanager
def temporary_log_folder() -> Iterator[Path]:
    """A new folder. The processes that use it must have ended when it is left; no error comes of what they did to it.

    Needs a running event loop.
    """
    loop = asyncio.get_running_loop()
    path, folder = private_folders.create("check")  # it stays the folder that we made, whatever takes its place

    next_look = loop.call_later(LOOK_EVERY_S, lambda: look())

    def look() -> None:
        nonlocal next_look
        keep_small(folder)
        next_look = loop.call_later(LOOK_EVERY_S, look)

    try:
        yield path
    finally:
        next_look.cancel()
        _remove(folder, path)
        os.close(folder)


async def limit(path: Path, most: int = MOST_OF_THE_APP) -> None:
    """Keep the log files in a folder small until this is cancelled. The folder may come into being later."""
    while True:
        with contextlib.suppress(OSError):
            folder = os.open(path, _FOLDER)
            try:
                keep_small(folder, most)
            finally:
                os.close(folder)
        await asyncio.sleep(LOOK_EVERY_S)


def keep_small(folder: int, most: int = MOST_BYTES) -> None:
    """Empty the log files in an open folder, and in the folders in it, if they take more than `most` bytes of disk."""
    with contextlib.ExitStack() as opened, contextlib.suppress(OSError):
        folders = [folder, *_opened(folder, _largest(folder, folders=True), _FOLDER, opened)]
        logs = [(each, _largest(each)) for each in folders]
        if _bytes(blocks for _, found in logs for blocks, _ in found) <= most:  # as nearly always: nothing is opened
            return
        files = [file for each, found in logs for file in _opened(each, found, _FILE, opened)]
        if _bytes(os.fstat(file).st_blocks for file in files) > most:
            for file in files:
                os.ftruncate(file, 0)  # loggers open it for appending, and go on at its new end


def _bytes(blocks: Iterable[int]) -> int:
    return 512 * sum(blocks)


def _largest(folder: int, *, folders: bool = False) -> list[tuple[int, str]]:
    """The log files in an open folder, or the folders in it, with the disk blocks of each; the largest of many."""
    with os.scandir(folder) as entries:
        found = [
            (_blocks(entry), entry.name)
            for entry in itertools.islice(entries, MOST_ENTRIES)
            if entry.is_dir(follow_symlinks=False) == folders and (folders or entry.name.endswith(".log"))
        ]
    return heapq.nlargest(MOST_OPENED, found)


def _opened(folder: int, found: Iterable[tuple[int, str]], flags: int, opened: contextlib.ExitStack) -> Iterator[int]:
    """Of what was found in a folder, opened: no links, and no file with another name elsewhere."""
    for _, name in found:
        with contextlib.suppress(OSError):
            handle = os.open(name, flags, dir_fd=folder)
            opened.callback(os.close, handle)
            status = os.fstat(handle)
            if flags == _FOLDER or (stat.S_ISREG(status.st_mode) and status.st_nlink == 1):
                yield handle


def _blocks(entry: os.DirEntry[str]) -> int:
    try:
        return entry.stat(follow_symlinks=False).st_blocks
    except OSError:
        return 0


def _remove(folder: int, path: Path) -> None:
    """Remove the folder, wherever it is now, and what stands in its place."""
    place = os.readlink(f"/proc/self/fd/{folder}")
    _empty(folder)
    with contextlib.suppress(OSError):
        os.rmdir(place)
    with contextlib.suppress(OSError):
        path.unlink()
    with contextlib.suppress(OSError):
        other = os.open(path, _FOLDER)
        _empty(other)
        os.close(other)
        path.rmdir()


def _empty(folder: int) -> None:
    """Remove what is in an open folder. Folders within folders come up level by level: their depth may be any."""
    before: set[str] = set()
    while True:
        with contextlib.suppress(OSError):
            os.fchmod(folder, 0o700)
        names = set(os.listdir(folder))
        if names == before:  # nothing, or what cannot be removed
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
    inner = os.open(name, _FOLDER, dir_fd=folder)
    try:
        for each in os.listdir(inner):
            if stat.S_ISDIR(os.stat(each, dir_fd=inner, follow_symlinks=False).st_mode):
                os.chmod(each, 0o700, dir_fd=inner)
                os.rename(each, uuid4().hex, src_dir_fd=inner, dst_dir_fd=folder)
            else:
                os.unlink(each, dir_fd=inner)
    finally:
        os.close(inner)
    os.rmdir(name, dir_fd=folder)
