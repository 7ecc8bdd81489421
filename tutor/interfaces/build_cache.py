"""The builds of interface packages in the user's cache folder: their places and locks, and how long they are kept."""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from tutor.ros import workspace_interfaces
from tutor.workspace.locking import lock

_STAMP = ".complete"
"""The file that is there once all others are; its time is that of the last use."""

_LOCK_LIMIT_S = 120.0
_KEPT_S = 30 * 24 * 3600.0
"""How long a build is kept after its last use."""


def place(name: str, digest: str) -> Path:
    """The prefix of a package's build, whether it is there or not. `digest`: of whatever the build depends on.

    Raises OSError.
    """
    return _folder() / f"{name}-{digest}"


def is_complete(prefix: Path) -> bool:
    """Whether there is a build, and nothing is missing from it."""
    return (prefix / _STAMP).is_file()


def note_use(prefix: Path) -> None:
    """Have a build be kept for as long as one that was made just now."""
    with suppress(OSError):
        os.utime(prefix / _STAMP)


def put(made: Path, prefix: Path) -> None:
    """Move a build, made beside its place, to that place; what is there goes. Raises OSError."""
    (made / _STAMP).touch()
    if prefix.exists():
        shutil.rmtree(prefix)
    made.rename(prefix)


@contextmanager
def locked(prefix: Path) -> Iterator[None]:
    """Keep other processes from building the same; after `_LOCK_LIMIT_S`, build all the same. Raises OSError."""
    handle = os.open(prefix.with_name(f".{prefix.name}.lock"), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    try:
        lock(handle, _LOCK_LIMIT_S)
        yield
    finally:
        os.close(handle)


def remove_unused() -> None:
    """Remove builds that nothing has used for long, and locks of builds that are gone."""
    for stamp in _folder().glob(f"*/{_STAMP}"):
        with suppress(OSError):
            if time.time() - stamp.stat().st_mtime > _KEPT_S:
                shutil.rmtree(stamp.parent, ignore_errors=True)
                stamp.parent.with_name(f".{stamp.parent.name}.lock").unlink(missing_ok=True)


def _folder() -> Path:
    return workspace_interfaces.cache_root() / "built"
