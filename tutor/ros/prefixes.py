"""Tells which entries of PATH-like variables belong to the bundled ROS, to another ROS, or to none."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

from tutor.ros import bundled_interfaces, workspace_interfaces
from tutor.ros.bundled_interfaces import PYTHON

SITE_PACKAGES = Path("lib") / PYTHON / "site-packages"
_INDEX = Path("share") / "ament_index" / "resource_index"
PACKAGE_INDEX, INTERFACE_INDEX = _INDEX / "packages", _INDEX / "rosidl_interfaces"
"""The folders of an ament prefix with a file for each of its packages, and for each of those that have types."""


def entries(environ: Mapping[str, str], name: str) -> list[str]:
    """Return the non-empty entries of a PATH-like variable, without duplicates, in order."""
    return list(dict.fromkeys(entry for entry in environ.get(name, "").split(os.pathsep) if entry))


def join_entries(parts: Iterable[str | Path]) -> str:
    """Join entries to the value of a PATH-like variable, without duplicates, in order."""
    return os.pathsep.join(dict.fromkeys(str(part) for part in parts))


def ament_prefixes(environ: Mapping[str, str] = os.environ) -> list[Path]:
    """Return the ament prefixes in use, the first of which wins."""
    return [Path(entry) for entry in entries(environ, "AMENT_PREFIX_PATH")]


def indexed(index: Path, prefixes: Iterable[Path]) -> dict[str, Path]:
    """Map each package in an index to the first prefix that has it, sorted by name."""
    found: dict[str, Path] = {}
    for prefix in prefixes:
        for package in os.listdir(prefix / index) if (prefix / index).is_dir() else ():
            found.setdefault(package, prefix)
    return dict(sorted(found.items()))


def is_bundled(entry: str | Path) -> bool:
    """Return whether a path is in the bundled ROS: our own environment, or what we add to it."""
    path = Path(entry)
    return any(path.is_relative_to(root) for root in _own_roots()) or workspace_interfaces.is_built(path)


def is_foreign_ros(entry: str | Path) -> bool:
    """Return whether a path is in an ament prefix (of ROS or of a workspace) other than the bundled one."""
    path = Path(entry)
    if is_bundled(path) or not path.is_absolute():
        return False
    if path.is_relative_to("/opt/ros"):
        return True
    # The deepest entry is <prefix>/lib/python3.N/site-packages.
    return any((parent / _INDEX).is_dir() for parent in (path, *path.parents[:4]))


def without_ros(environ: Mapping[str, str], name: str) -> list[str]:
    """Return the entries of a PATH-like variable that belong to no ROS at all."""
    return [entry for entry in entries(environ, name) if not is_bundled(entry) and not is_foreign_ros(entry)]


def without_bundled(environ: Mapping[str, str], name: str) -> list[str]:
    """Return the entries of a PATH-like variable without those of the bundled ROS."""
    return [entry for entry in entries(environ, name) if not is_bundled(entry)]


def bundled_libraries() -> list[Path]:
    """Return the folders with the bundled ROS's shared libraries, in a stable order."""
    site = Path(sys.prefix) / SITE_PACKAGES
    return [Path(sys.prefix) / "lib", bundled_interfaces.library_dir(), *sorted(site.glob("ros_*.libs"))]


def rclpy_site(prefix: Path) -> Path | None:
    """Return the folder in an ament prefix with an rclpy for our Python; None if there is none."""
    for site in (SITE_PACKAGES, Path("local") / "lib" / PYTHON / "dist-packages"):
        if any((prefix / site / "rclpy").glob(f"_rclpy_pybind11.{sys.implementation.cache_tag}-*.so")):
            return prefix / site
    return None


def holds_package(prefix: Path, package: str) -> bool:
    """Return whether an ament prefix holds this ROS package."""
    return (prefix / PACKAGE_INDEX / package).is_file()


def _own_roots() -> tuple[Path, ...]:
    # Outside a virtual environment, a prefix such as /usr also holds things that are not ours: only the wheels count.
    prefix = Path(sys.prefix)
    if sys.prefix == sys.base_prefix:
        prefix /= SITE_PACKAGES
    return (prefix, bundled_interfaces.prefix(), bundled_interfaces.startup_folder())
