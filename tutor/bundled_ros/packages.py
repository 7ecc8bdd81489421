"""Finding a ROS package's programs and files by the ament index, as `ros2 run` and launch's `Node` do.

Packages that are not built into a prefix are found all the same where `tutor.bundled_ros.ros2.overlay` has put them
there.
"""

from __future__ import annotations

import difflib
import os
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

INDEX = Path("share") / "ament_index" / "resource_index" / "packages"
_MUCH_LIKE = 0.8
_LONGEST_INTERPRETER = 110
"""Characters of a path; older kernels read 127 of a script's first line."""


class PackageNotFound(LookupError):
    """No prefix of AMENT_PREFIX_PATH has this package."""

    def __init__(self, package: str) -> None:
        self.package = package
        near = difflib.get_close_matches(package, packages_with_programs())
        self.hint = hint(package, packages_with_programs())
        super().__init__(f"package '{package}' not found" + (f"; is it {' or '.join(near)}?" if near else ""))


class ExecutableNotFound(LookupError):
    """The package is there, but has no program of this name."""

    def __init__(self, package: str, executable: str, programs: list[str]) -> None:
        self.package = package
        self.executable = executable
        self.hint = hint(executable, programs)
        super().__init__(f"executable '{executable}' not found in package '{package}'; it has: {_listed(programs)}")


def hint(name: str, names: Iterable[str]) -> str:
    """The end of a message that asks which of the names was meant; nothing where none is much like it."""
    near = difflib.get_close_matches(name, list(names), cutoff=_MUCH_LIKE)
    return f" (is it {' or '.join(near)}?)" if near else ""


def find_executable(package: str, executable: str) -> list[str]:
    """The command that starts a program of a package: one word, or the interpreter and our script.

    Raises PackageNotFound, ExecutableNotFound.
    """
    prefix = _prefix(package)
    found = _programs(prefix, package)
    if executable not in found:
        raise ExecutableNotFound(package, executable, sorted(found))
    program = str(found[executable])
    # Our own script's first line may be one that the kernel cannot read: too long, or with spaces in the path.
    unreadable = len(sys.executable) > _LONGEST_INTERPRETER or " " in sys.executable
    return [sys.executable, "-P", program] if unreadable and _is_our_script(found[executable]) else [program]


def programs_of(package: str) -> list[str]:
    """The names of a package's programs, sorted. Raises PackageNotFound."""
    return sorted(_programs(_prefix(package), package))


def find_share(package: str) -> Path:
    """The folder of a package's files: `launch/`, `config/` and the like are in it. Raises PackageNotFound."""
    return _prefix(package) / "share" / package


def programs(package: str) -> dict[str, Path]:
    """The programs of a package, by name. Raises PackageNotFound."""
    return _programs(_prefix(package), package)


def packages_with_programs() -> list[str]:
    """The names of all packages that have programs, sorted."""
    names = {
        path.name
        for prefix in _prefixes()
        if (prefix / INDEX).is_dir()
        for path in (prefix / INDEX).iterdir()
        if (prefix / "lib" / path.name).is_dir()
    }
    return sorted(names)


def has_package(package: str) -> bool:
    """Whether a prefix of AMENT_PREFIX_PATH has this package."""
    return _is_name(package) and any((prefix / INDEX / package).is_file() for prefix in _prefixes())


def _prefixes() -> Iterator[Path]:
    return (Path(entry) for entry in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if entry)


def _prefix(package: str) -> Path:
    for prefix in _prefixes():
        if _is_name(package) and (prefix / INDEX / package).is_file():
            return prefix
    raise PackageNotFound(package)


def _is_name(text: str) -> bool:
    return bool(text) and "/" not in text


def _programs(prefix: Path, package: str) -> dict[str, Path]:
    """The executable files of a package, by name."""
    found: dict[str, Path] = {}
    for folder, below, files in os.walk(prefix / "lib" / package):
        below[:] = sorted(name for name in below if not name.startswith("."))
        for name in sorted(files):
            if os.access(Path(folder) / name, os.X_OK):
                found.setdefault(name, Path(folder) / name)
    return found


def _is_our_script(program: Path) -> bool:
    with program.open("rb") as file:
        return file.read(4096).startswith(f"#!{sys.executable} ".encode())


def _listed(names: list[str]) -> str:
    return ", ".join(names) or "none"
