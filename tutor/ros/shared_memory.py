"""Whether ROS can be loaded with what is left of shared memory: 64 MB in a container, where nothing else is said."""

from __future__ import annotations

import os
from pathlib import Path

from tutor.ros import stale_segments

_PLACE = Path("/dev/shm")
_NEEDED = 2 * 4096


def problem(place: Path = _PLACE) -> str:
    """Why it cannot, in one sentence; empty where it can.

    Its tracing library maps a page for everybody and one for each user as soon as it is loaded. Where there is none
    left, the kernel kills the process (SIGBUS). Fast DDS does without shared memory, and says so.
    """
    try:
        found = os.statvfs(place)
    except OSError:
        return ""
    if not found.f_blocks or found.f_bavail * found.f_frsize >= _NEEDED or _has_pages(place):
        return ""
    size = found.f_blocks * found.f_frsize / 2**20
    hint = "remove from it what nobody needs, or give the container more (docker run --shm-size=1g)"
    return f"{place} is full ({size:.0f} MB), so that ROS cannot be loaded; {hint}"


def prove_enough() -> None:
    """Raise OSError where there is a `problem`, with what killed processes have left out of the way."""
    stale_segments.remove()
    if text := problem():
        raise OSError(text)


def _has_pages(place: Path) -> bool:
    held = [path.name for path in place.glob("lttng-ust-wait-*") if path.stat().st_blocks]
    return any(name.endswith(f"-{os.getuid()}") for name in held) and any(name.count("-") == 3 for name in held)
