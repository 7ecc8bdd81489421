"""Watches files on disk for changes by any program."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from pathlib import Path

POLL_INTERVAL_S = 0.4

_Stamp = tuple[int, int, int] | None


async def watch_files(paths: Sequence[Path], on_change: Callable[[Path], object]) -> None:
    """Call `on_change` with each of the files now, and after each change to it, until cancelled."""
    seen: dict[Path, _Stamp] = {}  # empty, so that the first look counts as a change
    while True:
        for path in paths:
            stamp = _stamp(path)
            if path not in seen or stamp != seen[path]:
                seen[path] = stamp
                on_change(path)
        await asyncio.sleep(POLL_INTERVAL_S)


def _stamp(path: Path) -> _Stamp:
    """Return what changes whenever the file does, or None if there is no file."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino
