"""Packages by name: those of the prefixes, and of the workspace around the current folder."""

from __future__ import annotations

import os
from pathlib import Path

from tutor.bundled_ros.packages import INDEX
from tutor.bundled_ros.ros2 import overlaying


def all_packages() -> list[str]:
    """The names of all packages, sorted."""
    overlaying.overlay_workspace(Path.cwd())
    prefixes = [Path(entry) for entry in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if entry]
    return sorted(
        {path.name for prefix in prefixes if (prefix / INDEX).is_dir() for path in (prefix / INDEX).iterdir()}
    )


def package_names(**_: object) -> list[str]:
    """The packages that Tab offers."""
    return all_packages()
