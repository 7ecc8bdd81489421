"""Look up a ROS package's executables and files in the ament index, for `ros2 run` and launch's `Node`.

Packages that were never built are found too, once `tutor.bundled_ros.ros2.overlay` has linked them into a prefix.
"""

from __future__ import annotations

import difflib
import importlib.util
import os
import sys
from collections.abc import Iterable
from pathlib import Path

from tutor.ros.prefixes import PACKAGE_INDEX, ament_prefixes, holds_package, indexed, is_bundled

_SIMILARITY_CUTOFF = 0.8
_MAX_INTERPRETER_LENGTH = 110
"""Longest interpreter path for a `#!` line, in characters: older kernels read only the line's first 127."""


class PackageNotFound(LookupError):
    """No prefix on AMENT_PREFIX_PATH has this package."""

    def __init__(self, package: str) -> None:
        self.package = package
        near = difflib.get_close_matches(package, packages_with_executables())
        self.hint = hint(package, packages_with_executables())
        super().__init__(f"package '{package}' not found" + (f"; is it {' or '.join(near)}?" if near else ""))


class ExecutableNotFound(LookupError):
    """The package exists but has no executable of this name."""

    def __init__(self, package: str, executable: str, executables: list[str]) -> None:
        self.package = package
        self.executable = executable
        self.hint = hint(executable, executables)
        super().__init__(f"executable '{executable}' not found in package '{package}'; it has: {_listed(executables)}")


def hint(name: str, names: Iterable[str]) -> str:
    """Return a " (is it NAME?)" suffix that suggests similar names; empty if none is similar enough."""
    near = difflib.get_close_matches(name, list(names), cutoff=_SIMILARITY_CUTOFF)
    return f" (is it {' or '.join(near)}?)" if near else ""


def find_executable(package: str, executable: str) -> list[str]:
    """Return the command that starts a package's executable: its path, or the interpreter followed by our script.

    Raises PackageNotFound or ExecutableNotFound.
    """
    prefix = _find_prefix(package)
    found = _find_executables(prefix, package)
    if executable not in found:
        raise ExecutableNotFound(package, executable, sorted(found))
    program = found[executable]
    line = _interpreter_line(program)
    if line.startswith(f"{sys.executable} "):
        # The kernel cannot run our own scripts if their #! line is too long or has spaces in the interpreter's path.
        unreadable = len(sys.executable) > _MAX_INTERPRETER_LENGTH or " " in sys.executable
        return [sys.executable, "-P", str(program)] if unreadable else [str(program)]
    return [sys.executable, str(program)] if _needs_our_rclpy(line) else [str(program)]


def executable_names(package: str) -> list[str]:
    """Return the sorted names of a package's executables. Raises PackageNotFound."""
    return sorted(_find_executables(_find_prefix(package), package))


def find_share(package: str) -> Path:
    """Return a package's share folder, which holds `launch/`, `config/` and the like. Raises PackageNotFound."""
    return _find_prefix(package) / "share" / package


def executables_of(package: str) -> dict[str, Path]:
    """Map the names of a package's executables to their paths. Raises PackageNotFound."""
    return _find_executables(_find_prefix(package), package)


def packages_with_executables() -> list[str]:
    """Return the sorted names of all packages that have executables."""
    return [name for name, prefix in _packages().items() if (prefix / "lib" / name).is_dir()]


def all_packages() -> list[str]:
    """Return the sorted names of all packages."""
    return list(_packages())


def has_package(package: str) -> bool:
    """Return whether a prefix on AMENT_PREFIX_PATH has this package."""
    return _is_valid_name(package) and any(holds_package(prefix, package) for prefix in ament_prefixes())


def _packages() -> dict[str, Path]:
    return indexed(PACKAGE_INDEX, ament_prefixes())


def _find_prefix(package: str) -> Path:
    for prefix in ament_prefixes():
        if _is_valid_name(package) and holds_package(prefix, package):
            return prefix
    raise PackageNotFound(package)


def _is_valid_name(text: str) -> bool:
    return bool(text) and "/" not in text


def _find_executables(prefix: Path, package: str) -> dict[str, Path]:
    """Map the names of a package's executable files to their paths."""
    found: dict[str, Path] = {}
    for folder, below, files in os.walk(prefix / "lib" / package):
        below[:] = sorted(name for name in below if not name.startswith("."))
        for name in sorted(files):
            if os.access(Path(folder) / name, os.X_OK):
                found.setdefault(name, Path(folder) / name)
    return found


def _interpreter_line(program: Path) -> str:
    """Return what follows `#!` in a script's first line; empty for any other program."""
    with program.open("rb") as file:
        first = file.read(4096).partition(b"\n")[0]
    return os.fsdecode(first[2:]).strip() if first.startswith(b"#!") else ""


def _needs_our_rclpy(line: str) -> bool:
    """Return whether a script's `#!` line names a Python without rclpy, such as colcon's, and ours has the bundled one.

    colcon builds scripts for the Python that runs it. Where ROS is installed, that one finds ROS's rclpy.
    """
    python = Path(line.partition(" ")[0])
    if not (python.is_absolute() and python.name.startswith("python")):
        return False
    if any((python.parent.parent / "lib").glob("python3*/site-packages/rclpy")):
        return False
    ours = importlib.util.find_spec("rclpy")
    return ours is not None and ours.origin is not None and is_bundled(ours.origin)


def _listed(names: list[str]) -> str:
    return ", ".join(names) or "none"
