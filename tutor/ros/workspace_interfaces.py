"""Where the interface packages of a workspace are once `tutor.interfaces` has built them, and how a process finds them.

Each is an ament prefix in the user's cache folder, named after a digest of all that it was made of. A workspace has a
folder of links to its own, so that a terminal opened before a change finds what was built after it.
"""

from __future__ import annotations

import ctypes
import hashlib
import importlib
import os
import sys
from collections.abc import Iterable, Mapping, MutableMapping
from pathlib import Path

SITE_PACKAGES = Path("python")
"""The folder of a prefix from which Python imports the package."""

REASONS = "ROS_TUTOR_INTERFACES"
"""The variable that names a folder with a text for each package that could not be built: NAME.unbuilt."""

_FOLDERS = {"AMENT_PREFIX_PATH": Path("."), "PYTHONPATH": SITE_PACKAGES, "LD_LIBRARY_PATH": Path("lib")}
"""The variables by which a process finds a prefix, and which of its folders belongs into each."""


def cache_root(environ: Mapping[str, str] = os.environ) -> Path:
    """Return the folder for all that is built, which need not exist: in the user's cache folder. Raises OSError."""
    if (given := environ.get("XDG_CACHE_HOME", "")) and os.path.isabs(given):
        return Path(given, "ros-tutor", "interfaces")
    home = Path(os.path.expanduser("~"))
    if home.is_dir() and os.access(home, os.W_OK):
        return home / ".cache" / "ros-tutor" / "interfaces"
    from tutor import private_folders  # late: every `ros2` command imports this module

    return private_folders.base() / "interfaces"


def links_folder(workspace: Path) -> Path:
    """Return the folder with a link to each built package of a workspace, by its name. Raises OSError."""
    place = hashlib.sha256(os.fsencode(os.path.realpath(workspace))).hexdigest()[:16]
    return cache_root() / "workspaces" / place


def built(workspace: Path) -> list[Path]:
    """Return the prefixes of a workspace's packages that are built; some may be of an older state of their files."""
    try:
        return sorted(link for link in links_folder(workspace).iterdir() if link.is_dir())
    except OSError:
        return []


def add(env: MutableMapping[str, str], workspace: Path) -> None:
    """Make processes with this environment find the built packages of a workspace, before any others of their names.

    A Python program that imports one that could not be built is told why (see `bundled_ros/startup`).
    """
    add_prefixes(env, built(workspace))
    env.pop(REASONS, None)
    try:
        if (folder := links_folder(workspace)).is_dir():
            env[REASONS] = str(folder)
    except OSError:
        pass


def add_prefixes(env: MutableMapping[str, str], found: Iterable[Path]) -> None:
    """Make processes with this environment find the packages in these prefixes."""
    found = list(found)
    for name, below in _FOLDERS.items():
        if found:
            env[name] = _joined([*(str(prefix / below) for prefix in found), *_entries(env, name)])


def keep(env: MutableMapping[str, str], environ: Mapping[str, str]) -> None:
    """Add to `env` what `add` has added to `environ`, which is the environment of a sourced terminal, say."""
    for name in _FOLDERS:
        if found := [entry for entry in _entries(environ, name) if is_built(entry)]:
            env[name] = _joined([*found, *_entries(env, name)])


def activate(prefix: Path, package: str) -> None:
    """Import a package from this prefix into this process, which is prepared for rclpy, unless it has imported one.

    Raises OSError if a library cannot be loaded, and ImportError.
    """
    if package in sys.modules:
        return
    for library in sorted((prefix / "lib").glob("*.so")):  # see tutor.ros.bundled_interfaces
        ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    sys.path[:] = [str(prefix / SITE_PACKAGES), *(entry for entry in sys.path if entry != str(prefix / SITE_PACKAGES))]
    importlib.invalidate_caches()
    os.environ["AMENT_PREFIX_PATH"] = _joined([str(prefix), *_entries(os.environ, "AMENT_PREFIX_PATH")])
    for module in (prefix / SITE_PACKAGES / package).glob("*/__init__.py"):
        importlib.import_module(f"{package}.{module.parent.name}")
    importlib.import_module(f"{package}.{package}_s__rosidl_typesupport_c")


def is_built(entry: str | Path) -> bool:
    """Return whether a path is in a package that was built for a workspace."""
    try:
        return Path(entry).is_relative_to(cache_root())
    except OSError:
        return False


def _entries(environ: Mapping[str, str], name: str) -> list[str]:
    return [entry for entry in environ.get(name, "").split(os.pathsep) if entry]


def _joined(parts: Iterable[str]) -> str:
    return os.pathsep.join(dict.fromkeys(parts))
