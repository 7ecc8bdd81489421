"""Follows a file on disk, whoever changes it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

from tutor.tui.messages import FileRead

LOOK_EVERY_S = 0.4
_LARGEST = 1 << 20

_Stamp = tuple[int, int, int] | None


async def follow(path: Path, tell: Callable[[FileRead], object]) -> None:
    """Tell the file's text now and after each change, until cancelled."""
    seen: object = "nothing yet"
    while True:
        stamp, message = await asyncio.to_thread(_look, path, seen)
        if message is not None:
            tell(message)
        seen = stamp
        await asyncio.sleep(LOOK_EVERY_S)  # the pace of looking, not a wait for anything


def _look(path: Path, seen: object) -> tuple[_Stamp, FileRead | None]:
    stamp: _Stamp = None
    try:
        status = path.stat()
        stamp = (status.st_mtime_ns, status.st_size, status.st_ino)
        if stamp == seen:
            return stamp, None
        with path.open("rb") as file:
            text = file.read(_LARGEST).decode("utf-8", "replace")
        return stamp, FileRead(path, text)
    except FileNotFoundError:
        return None, None if seen is None else FileRead(path, None)
    except OSError as error:
        return stamp, FileRead(path, None, error.strerror or str(error))
