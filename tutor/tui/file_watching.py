"""Watches a file on disk for changes by any program."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

POLL_INTERVAL_S = 0.4

_Stamp = tuple[int, int, int] | None


async def watch_file(path: Path, on_change: Callable[[], object]) -> None:
    """Call `on_change` now and after each change to the file, until cancelled."""
    seen: object = "nothing yet"  # unlike any stamp, so that the first look counts as a change
    while True:
        stamp = _stamp(path)
        if stamp != seen:
            seen = stamp
            on_change()
        await asyncio.sleep(POLL_INTERVAL_S)


def _stamp(path: Path) -> _Stamp:
    """Return what changes whenever the file does, or None if there is no file."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino
