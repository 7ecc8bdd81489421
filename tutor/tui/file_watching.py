"""Watches a file on disk for changes by any program."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

LOOK_EVERY_S = 0.4

_Stamp = tuple[int, int, int] | None


async def watch_file(path: Path, tell: Callable[[], object]) -> None:
    """Call `tell` now and after each change of the file, until cancelled."""
    seen: object = "nothing yet"
    while True:
        stamp = _stamp(path)
        if stamp != seen:
            seen = stamp
            tell()
        await asyncio.sleep(LOOK_EVERY_S)  # the pace of looking, not a wait for anything


def _stamp(path: Path) -> _Stamp:
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino
