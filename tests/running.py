"""Which processes run on this machine, according to /proc."""

from __future__ import annotations

from pathlib import Path


def is_running(file: Path) -> bool:
    """Return whether a running process has this file on its command line."""
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            if str(file).encode() in (folder / "cmdline").read_bytes().split(b"\0"):
                return True
        except OSError:  # it has just ended
            continue
    return False
