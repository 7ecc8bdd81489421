"""Removes Fast DDS shared memory left behind by killed processes: about 600 kB each, which nobody else cleans up.

Fast DDS's own rule for a stale `fastrtps_NAME` in /dev/shm: it has a lock file beside it (`_el`, `_sl`), but nobody
holds the lock, since the kernel releases the locks of a dead process. We hold the lock while removing the files; for a
port, which processes share, also its named mutex. Fast DDS is prepared for that: after taking a lock, it checks that
the lock file still exists.
"""

from __future__ import annotations

import contextlib
import ctypes
import fcntl
import os
import re
import stat
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

_FOLDER = Path("/dev/shm")
_LOCK_NAME = re.compile(r"(fastrtps_(?:[0-9a-f]{16}|port[0-9]{1,5}))_[es]l")
_LIMIT_S = 0.2
_READ_FLAGS = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC


def remove(place: Path = _FOLDER, limit_s: float = _LIMIT_S) -> None:
    """Remove the user's own stale segments, for up to `limit_s` seconds; the next call continues. Never raises."""
    deadline = time.monotonic() + limit_s
    try:
        names = sorted({found[1] for name in os.listdir(place) if (found := _LOCK_NAME.fullmatch(name))})
    except OSError:
        return
    for name in names:
        if time.monotonic() > deadline:
            return
        with contextlib.suppress(OSError):
            _remove(place, name)


def _remove(place: Path, name: str) -> None:
    """Remove one segment. Raises BlockingIOError if it is in use, PermissionError if it is another user's."""
    mutex = f"{name}_mutex" if "_port" in name else ""
    with _hold_mutex(mutex) if mutex else contextlib.nullcontext(), ExitStack() as locks:
        held = [lock for lock in (place / f"{name}_el", place / f"{name}_sl") if _lock(lock, locks)]
        if not held:
            return
        for path in (place / name, *held, *([place / f"sem.{mutex}"] if mutex else [])):
            with contextlib.suppress(FileNotFoundError):
                path.unlink()


def _lock(path: Path, locks: ExitStack) -> bool:
    """Take this lock until `locks` is closed. Return False if there is no such file."""
    try:
        handle = os.open(path, _READ_FLAGS)
    except FileNotFoundError:
        return False
    locks.callback(os.close, handle)
    status = os.fstat(handle)
    if not stat.S_ISREG(status.st_mode) or status.st_uid != os.getuid():
        raise PermissionError(path)
    fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    return True


@contextmanager
def _hold_mutex(mutex: str) -> Iterator[None]:
    """Hold a named Boost mutex, which is a POSIX semaphore. Raises BlockingIOError if it is taken."""
    library = ctypes.CDLL(None, use_errno=True)
    library.sem_open.restype = ctypes.c_void_p
    semaphore = ctypes.c_void_p(library.sem_open(f"/{mutex}".encode(), 0))
    if semaphore.value is None:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()), mutex)
    try:
        if library.sem_trywait(semaphore) != 0:
            raise BlockingIOError(mutex)
        try:
            yield
        finally:
            library.sem_post(semaphore)
    finally:
        library.sem_close(semaphore)
