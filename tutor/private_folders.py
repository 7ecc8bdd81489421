"""Folders for temporary files that nobody else of the machine can have prepared or can look into.

They lie in one folder of the user's. Making one removes those whose makers were killed: who lives, holds a lock.
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

_FOLDER = os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC


def base() -> Path:
    """The user's own folder, made where it is missing: another one where somebody has taken its name.

    Raises OSError where no temporary file can be written.
    """
    try:
        temporary = Path(tempfile.gettempdir())
    except FileNotFoundError:
        text = "no folder for temporary files can be written to; set TMPDIR to one that can: export TMPDIR=$HOME/tmp"
        raise OSError(text) from None
    name = f"ros-tutor-{os.getuid()}"
    with contextlib.suppress(OSError):
        (temporary / name).mkdir(mode=0o700)
    for path in (temporary / name, *sorted(temporary.glob(f"{name}-*"))):
        if _is_ours(path):
            return path
    return Path(tempfile.mkdtemp(prefix=f"{name}-"))


def logs(environ: Mapping[str, str] = os.environ) -> Path:
    """Where nodes that the user runs keep their log files: where they say, else in `base`. Raises OSError."""
    return Path(environ.get("ROS_LOG_DIR") or base() / "log")


def contains(path: Path) -> bool:
    """Whether a path is in `base`: not a place of the user's own. Raises OSError."""
    return path.is_relative_to(base())


def create(name: str) -> tuple[Path, int]:
    """A new folder in `base`, and its descriptor, to be kept open for as long as the folder is used. Raises OSError."""
    around = os.open(base(), _FOLDER)
    try:
        fcntl.flock(around, fcntl.LOCK_EX)  # a folder that has just been made is not locked yet
        place = Path(os.readlink(f"/proc/self/fd/{around}"))
        _sweep(place)
        path = Path(tempfile.mkdtemp(prefix=f"{name}.", dir=place))
        handle = os.open(path, _FOLDER)
        fcntl.flock(handle, fcntl.LOCK_EX)
        return path, handle
    finally:
        os.close(around)


@contextmanager
def temporary(name: str) -> Iterator[Path]:
    """A new folder, gone after the block. Raises OSError."""
    path, handle = create(name)
    try:
        yield path
    finally:
        _remove(path)
        os.close(handle)


def until_exit(name: str) -> Path:
    """A new folder that lasts as long as this process. Raises OSError."""
    path, _ = create(name)
    atexit.register(_remove, path)
    return path


def _is_ours(path: Path) -> bool:
    try:
        handle = os.open(path, _FOLDER)
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


def _sweep(place: Path) -> None:
    for path in place.glob("*.*"):
        with contextlib.suppress(OSError):
            handle = os.open(path, _FOLDER)
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
                _remove(path)
            finally:
                os.close(handle)


def _remove(path: Path) -> None:
    with contextlib.suppress(RecursionError):
        shutil.rmtree(path, ignore_errors=True)
