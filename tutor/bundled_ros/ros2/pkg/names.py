"""Package names: those in the ament prefixes and in the workspace around the current folder."""

from __future__ import annotations

from pathlib import Path

from tutor.bundled_ros import packages
from tutor.bundled_ros.ros2 import use_overlay


def all_packages() -> list[str]:
    """Add the workspace's packages to the environment and return the sorted names of all packages."""
    use_overlay.overlay_workspace(Path.cwd())
    return packages.all_packages()


def complete_packages(**_: object) -> list[str]:
    """Complete package names."""
    return all_packages()
