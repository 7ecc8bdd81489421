"""Look up packages and their executables with a resolver, if one is set, else in the ament index."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Protocol

from launch._entities import SubstitutionFailure


class Resolver(Protocol):
    """Finds packages. Raises LookupError, with a message for the user, if it does not."""

    def find_executable(self, package: str, executable: str) -> list[str]:
        """Return the command words that run the executable."""

    def find_share(self, package: str) -> Path:
        """Return the package's share folder."""


class PackageNotFoundError(KeyError):
    """There is no package of this name."""

    def __str__(self) -> str:
        return str(self.args[0])


resolver: Resolver | None = None
"""Replaces the ament index; set by the code that runs the launch file."""


def find_executable(package: str, executable: str) -> list[str]:
    """Return the command words of a package's executable. Raises SubstitutionFailure or PackageNotFoundError."""
    if resolver is not None:
        try:
            return resolver.find_executable(package, executable)
        except LookupError as error:
            raise _to_substitution_failure(error) from error
    prefix = _find_prefix_in_index(package)
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
    """Return a package's share folder. Raises SubstitutionFailure or PackageNotFoundError."""
    if resolver is None:
        return str(_find_prefix_in_index(package) / "share" / package)
    try:
        return str(resolver.find_share(package))
    except LookupError as error:
        raise _to_substitution_failure(error) from error


def find_prefix(package: str) -> str:
    """Return the prefix that a package is installed in. Raises SubstitutionFailure or PackageNotFoundError."""
    return str(Path(find_share(package)).parent.parent)


def _find_prefix_in_index(package: str) -> Path:
    searched = [entry for entry in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if entry]
    for prefix in searched:
        if (Path(prefix) / "share/ament_index/resource_index/packages" / package).is_file():
            return Path(prefix)
    raise PackageNotFoundError(f"\"package '{package}' not found, searching: {searched}\"")


def _to_substitution_failure(error: LookupError) -> SubstitutionFailure:
    # str() of a KeyError is the repr of its message.
    return SubstitutionFailure(str(error.args[0]) if error.args else str(error))
