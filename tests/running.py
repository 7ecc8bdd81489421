"""What runs on this machine, as /proc tells it."""

from __future__ import annotations

from pathlib import Path


def runs(file: Path) -> bool:
    """Whether a process has been started with this file."""
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            if str(file).encode() in (folder / "cmdline").read_bytes().split(b"\0"):
                return True
        except OSError:  # it has just ended
            continue
    return False
