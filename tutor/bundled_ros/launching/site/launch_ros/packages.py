"""Where packages and their executables are: where the one who runs us says, else in the ament index."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Protocol

from launch._entities import SubstitutionFailure


class Resolver(Protocol):
    """Knows all packages there are. What it does not know it answers with a LookupError that says so."""

    def find_executable(self, package: str, executable: str) -> list[str]:
        """The words of the command that runs it."""

    def find_share(self, package: str) -> Path:
        """The package's share folder."""


class PackageNotFoundError(KeyError):
    """Nobody knows a package of this name."""

    def __str__(self) -> str:
        return str(self.args[0])


resolver: Resolver | None = None
"""Asked instead of the ament index; set by the one who runs the launch file."""


def find_executable(package: str, executable: str) -> list[str]:
    """The command of a package's executable; SubstitutionFailure or PackageNotFoundError where there is none."""
    if resolver is not None:
        try:
            return resolver.find_executable(package, executable)
        except LookupError as error:
            raise _as_failure(error) from error
    prefix = _prefix_in_index(package)
    folder = prefix / "lib" / package
    if not folder.is_dir():
        raise SubstitutionFailure(
            f"package '{package}' found at '{prefix}', but libexec directory '{folder}' does not exist"
        )
    found = shutil.which(executable, path=folder)
    if found is None:
        raise SubstitutionFailure(f"executable '{executable}' not found on the libexec directory '{folder}' ")
    return [found]


def find_share(package: str) -> str:
    """The share folder of a package; PackageNotFoundError where nobody knows it."""
    if resolver is None:
        return str(_prefix_in_index(package) / "share" / package)
    try:
        return str(resolver.find_share(package))
    except LookupError as error:
        raise _as_failure(error) from error


def find_prefix(package: str) -> str:
    """The folder that a package is installed in; PackageNotFoundError where nobody knows it."""
    return str(Path(find_share(package)).parent.parent)


def _prefix_in_index(package: str) -> Path:
    searched = [part for part in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if part]
    for prefix in searched:
        if (Path(prefix) / "share/ament_index/resource_index/packages" / package).is_file():
            return Path(prefix)
    raise PackageNotFoundError(f"\"package '{package}' not found, searching: {searched}\"")


def _as_failure(error: LookupError) -> SubstitutionFailure:
    # A KeyError's text is the repr of its message.
    return SubstitutionFailure(str(error.args[0]) if error.args else str(error))
