"""Checks whether enough shared memory is left to load ROS. A container has 64 MB by default."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from tutor.ros import stale_segments

_FOLDER = Path("/dev/shm")
_NEEDED_BYTES = 2 * 4096
HINT = "delete files there that nobody needs, or give the container more (docker run --shm-size=1g)"


@dataclass(frozen=True, slots=True)
class FreeSpace:
    """Size and free space of shared memory in bytes. `enough`: ROS can be loaded."""

    folder: Path
    size: int
    free: int
    enough: bool


def free_space(folder: Path = _FOLDER) -> FreeSpace | None:
    """Return the free space in shared memory; None if the machine has none, or no limit on it.

    Loading ROS makes its tracing library (LTTng) map one page for all users and one per user. If no page is left, the
    kernel kills the process (SIGBUS). Fast DDS, in contrast, prints a message and works without shared memory.
    """
    try:
        found = os.statvfs(folder)
    except OSError:
        return None
    if not found.f_blocks:
        return None
    free = found.f_bavail * found.f_frsize
    return FreeSpace(folder, found.f_blocks * found.f_frsize, free, free >= _NEEDED_BYTES or _has_pages(folder))


def problem(folder: Path = _FOLDER) -> str:
    """Return one sentence on why ROS cannot be loaded and what to do; empty if it can."""
    found = free_space(folder)
    if found is None or found.enough:
        return ""
    return f"{folder} is full ({found.size / 2**20:.0f} MB), so ROS cannot be loaded; {HINT}"


def require_enough() -> None:
    """Remove what killed processes have left behind, then raise OSError if there still is a `problem`."""
    stale_segments.remove()
    if text := problem():
        raise OSError(text)


def _has_pages(folder: Path) -> bool:
    held = [path.name for path in folder.glob("lttng-ust-wait-*") if path.stat().st_blocks]
    return any(name.endswith(f"-{os.getuid()}") for name in held) and any(name.count("-") == 3 for name in held)
