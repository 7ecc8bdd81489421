"""Package names: those in the ament prefixes and in the workspace around the current folder."""

from __future__ import annotations

import os
from pathlib import Path

from tutor.bundled_ros.packages import INDEX
from tutor.bundled_ros.ros2 import use_overlay


def all_packages() -> list[str]:
    """Add the workspace's packages to the environment and return the sorted names of all packages."""
    use_overlay.overlay_workspace(Path.cwd())
    prefixes = [Path(entry) for entry in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if entry]
    return sorted(
        {path.name for prefix in prefixes if (prefix / INDEX).is_dir() for path in (prefix / INDEX).iterdir()}
    )


def package_names(**_: object) -> list[str]:
    """Complete package names."""
    return all_packages()
