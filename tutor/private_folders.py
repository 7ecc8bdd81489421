"""Temporary folders that no other user of the machine can prepare or read.

They are inside one folder per user. Creating one removes the leftovers of killed processes: a live one holds a lock.
"""

from __future__ import annotations

import atexit
import contextlib
import fcntl
import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

_FOLDER_FLAGS = os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC


def base() -> Path:
    """Return the user's own folder, created if missing, under another name if someone else has taken the usual one.

    Raises OSError if no temporary files can be written.
    """
    try:
        temporary = Path(tempfile.gettempdir())
    except FileNotFoundError:
        text = "no folder for temporary files is writable; set TMPDIR to one that is: export TMPDIR=$HOME/tmp"
        raise OSError(text) from None
    name = f"ros-tutor-{os.getuid()}"
    with contextlib.suppress(OSError):
        (temporary / name).mkdir(mode=0o700)
    for path in (temporary / name, *sorted(temporary.glob(f"{name}-*"))):
        if _is_ours(path):
            return path
    return Path(tempfile.mkdtemp(prefix=f"{name}-"))


def logs(environ: Mapping[str, str] = os.environ) -> Path:
    """Return the log folder for nodes that the user runs: ROS_LOG_DIR, else one in `base`. Raises OSError."""
    return Path(environ.get("ROS_LOG_DIR") or base() / "log")


def contains(path: Path) -> bool:
    """Return whether a path is in `base`, and so not chosen by the user. Raises OSError."""
    return path.is_relative_to(base())


def create(name: str) -> tuple[Path, int]:
    """Create a folder in `base`. Return it with its descriptor, to be kept open while it is in use. Raises OSError."""
    parent_handle = os.open(base(), _FOLDER_FLAGS)
    try:
        fcntl.flock(parent_handle, fcntl.LOCK_EX)  # or another process could sweep the new folder before it is locked
        parent = Path(os.readlink(f"/proc/self/fd/{parent_handle}"))
        _sweep(parent)
        path = Path(tempfile.mkdtemp(prefix=f"{name}.", dir=parent))
        handle = os.open(path, _FOLDER_FLAGS)
        fcntl.flock(handle, fcntl.LOCK_EX)
        return path, handle
    finally:
        os.close(parent_handle)


@contextmanager
def temporary(name: str) -> Iterator[Path]:
    """Create a folder that is removed after the `with` block. Raises OSError."""
    path, handle = create(name)
    try:
        yield path
    finally:
        _remove(path)
        os.close(handle)


def create_until_exit(name: str) -> Path:
    """Create a folder that lasts as long as this process. Raises OSError."""
    path, _ = create(name)
    atexit.register(_remove, path)
    return path


def _is_ours(path: Path) -> bool:
    try:
        handle = os.open(path, _FOLDER_FLAGS)
    except OSError:
        return False
    try:
        if os.fstat(handle).st_uid != os.getuid():
            return False
        os.fchmod(handle, 0o700)
        return True
    except OSError:
        return False
    finally:
        os.close(handle)


def _sweep(parent: Path) -> None:
    for path in parent.glob("*.*"):
        with contextlib.suppress(OSError):
            handle = os.open(path, _FOLDER_FLAGS)
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
                _remove(path)
            finally:
                os.close(handle)


def _remove(path: Path) -> None:
    with contextlib.suppress(RecursionError):
        shutil.rmtree(path, ignore_errors=True)
