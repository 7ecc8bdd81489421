"""What killed processes have left of Fast DDS's shared memory: some 600 kB each, which nobody else ever removes.

A file `fastrtps_NAME` in /dev/shm is stale by Fast DDS's own rule: it has a file of locks beside it (`_el`, `_sl`),
and nobody holds the lock, for the kernel lets go of what a process held that is gone. The process that removes it
holds the lock meanwhile; a port's, where processes meet, also its named mutex. Fast DDS looks again for a lock's file
once it has it.
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

_PLACE = Path("/dev/shm")
_LOCK = re.compile(r"(fastrtps_(?:[0-9a-f]{16}|port[0-9]{1,5}))_[es]l")
_LIMIT_S = 0.2
_READ = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC


def remove(place: Path = _PLACE, limit_s: float = _LIMIT_S) -> None:
    """Remove the user's own that are stale, for at most `limit_s` seconds; the next time goes on. Raises nothing."""
    deadline = time.monotonic() + limit_s
    try:
        names = sorted({found[1] for name in os.listdir(place) if (found := _LOCK.fullmatch(name))})
    except OSError:
        return
    for name in names:
        if time.monotonic() > deadline:
            return
        with contextlib.suppress(OSError):
            _remove(place, name)


def _remove(place: Path, name: str) -> None:
    """Remove one of them. Raises BlockingIOError where it is in use, PermissionError where it is another user's."""
    mutex = f"{name}_mutex" if "_port" in name else ""
    with _held(mutex) if mutex else contextlib.nullcontext(), ExitStack() as locks:
        held = [lock for lock in (place / f"{name}_el", place / f"{name}_sl") if _lock(lock, locks)]
        if not held:
            return
        for path in (place / name, *held, *([place / f"sem.{mutex}"] if mutex else [])):
            with contextlib.suppress(FileNotFoundError):
                path.unlink()


def _lock(path: Path, locks: ExitStack) -> bool:
    """Hold this lock as long as `locks`; False where there is no such file."""
    try:
        handle = os.open(path, _READ)
    except FileNotFoundError:
        return False
    locks.callback(os.close, handle)
    facts = os.fstat(handle)
    if not stat.S_ISREG(facts.st_mode) or facts.st_uid != os.getuid():
        raise PermissionError(path)
    fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    return True


@contextmanager
def _held(mutex: str) -> Iterator[None]:
    """Hold a named mutex of Boost's, which is a POSIX semaphore. Raises BlockingIOError where somebody else does."""
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
