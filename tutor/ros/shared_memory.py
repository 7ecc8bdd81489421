"""Whether ROS can be loaded with what is left of shared memory: 64 MB in a container, where nothing else is said."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from tutor.ros import stale_segments

_PLACE = Path("/dev/shm")
_NEEDED = 2 * 4096
HINT = "remove from it what nobody needs, or give the container more (docker run --shm-size=1g)"


@dataclass(frozen=True, slots=True)
class Room:
    """What there is of it, in bytes. `enough`: ROS can be loaded."""

    place: Path
    size: int
    free: int
    enough: bool


def room(place: Path = _PLACE) -> Room | None:
    """What there is of shared memory; None where the machine has none, or has not limited it.

    Its tracing library maps a page for everybody and one for each user as soon as ROS is loaded. Where there is none
    left, the kernel kills the process (SIGBUS). Fast DDS does without shared memory, and says so.
    """
    try:
        found = os.statvfs(place)
    except OSError:
        return None
    if not found.f_blocks:
        return None
    free = found.f_bavail * found.f_frsize
    return Room(place, found.f_blocks * found.f_frsize, free, free >= _NEEDED or _has_pages(place))


def problem(place: Path = _PLACE) -> str:
    """Why ROS cannot be loaded with it, and what to do, in one sentence; empty where it can."""
    found = room(place)
    if found is None or found.enough:
        return ""
    return f"{place} is full ({found.size / 2**20:.0f} MB), so that ROS cannot be loaded; {HINT}"


def require_enough() -> None:
    """Raise OSError where there is a `problem`, with what killed processes have left out of the way."""
    stale_segments.remove()
    if text := problem():
        raise OSError(text)


def _has_pages(place: Path) -> bool:
    held = [path.name for path in place.glob("lttng-ust-wait-*") if path.stat().st_blocks]
    return any(name.endswith(f"-{os.getuid()}") for name in held) and any(name.count("-") == 3 for name in held)
