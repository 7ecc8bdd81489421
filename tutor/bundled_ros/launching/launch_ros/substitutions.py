"""ROS-specific substitutions."""

from __future__ import annotations

import shlex
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from tutor.bundled_ros import packages
from tutor.bundled_ros.launching.launch.base import LaunchContext, SomeSubstitutionsType, Substitution
from tutor.bundled_ros.launching.launch.lookup import FoundPath
from tutor.bundled_ros.launching.launch.text import SUBSTITUTIONS
from tutor.bundled_ros.launching.launch.values import (
    SubstitutionFailure,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class FindPackage(FoundPath):
    """Base class of substitutions that find a package's folder."""

    def __init__(self, package: SomeSubstitutionsType) -> None:
        super().__init__()
        self._package = normalize_to_list_of_substitutions(package)

    def find(self, package_name: str) -> str:
        """Return the folder of the package with this name."""
        raise NotImplementedError

    def describe(self) -> str:
        return f"{type(self).__name__}(pkg={' + '.join(part.describe() for part in self._package)})"

    def perform(self, context: LaunchContext) -> str:
        return self.find(perform_substitutions(context, self._package))


def _find_share(package: str) -> Path:
    try:
        return packages.find_share(package)
    except LookupError as error:
        raise SubstitutionFailure(str(error.args[0])) from error


class FindPackagePrefix(FindPackage):
    """The prefix that a package is installed in."""

    def find(self, package_name: str) -> str:
        return str(_find_share(package_name).parent.parent)


class FindPackageShare(FindPackage):
    """A package's share folder, which holds its launch files and parameter files."""

    def find(self, package_name: str) -> str:
        return str(_find_share(package_name))


class ExecutableInPackage(Substitution):
    """An executable's path. As the first item of a command, it expands to all words needed to run the executable."""

    def __init__(self, executable: SomeSubstitutionsType, package: SomeSubstitutionsType) -> None:
        self._executable = normalize_to_list_of_substitutions(executable)
        self._package = normalize_to_list_of_substitutions(package)

    def describe(self) -> str:
        executable = " + ".join(part.describe() for part in self._executable)
        package = " + ".join(part.describe() for part in self._package)
        return f"ExecInPkg(pkg={package}, exec={executable})"

    def perform(self, context: LaunchContext) -> str:
        words = self.perform_words(context)
        return words[0] if len(words) == 1 else shlex.join(words)

    def perform_words(self, context: LaunchContext) -> list[str]:
        """Return the words of the command."""
        executable = perform_substitutions(context, self._executable)
        package = perform_substitutions(context, self._package)
        try:
            return packages.find_executable(package, executable)
        except LookupError as error:
            raise SubstitutionFailure(str(error.args[0])) from error

    def perform_name(self, context: LaunchContext) -> str:
        """Return the executable's name."""
        return perform_substitutions(context, self._executable)


class Parameter(Substitution):
    """A parameter's value as a text. Without one set in this scope, the default; if there is none, it fails."""

    def __init__(self, name: SomeSubstitutionsType, *, default: Any = None) -> None:
        self._name = normalize_to_list_of_substitutions(name)
        items = default if isinstance(default, Iterable) and not isinstance(default, str) else [default]
        texts = [item if isinstance(item, str | Substitution) else str(item) for item in items]
        self._default = None if default is None else normalize_to_list_of_substitutions(texts)

    def describe(self) -> str:
        return f"Parameter(name={' + '.join(part.describe() for part in self._name)})"

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self._name)
        for item in context.launch_configurations.get("global_params") or ():
            if isinstance(item, tuple) and item[0] == name:
                return str(item[1])
        if self._default is None:
            raise SubstitutionFailure(f"parameter '{name}' not found")
        return perform_substitutions(context, self._default)


SUBSTITUTIONS |= {
    "exec-in-pkg": (2, 2, lambda executable, package: ExecutableInPackage(executable=executable, package=package)),
    "find-pkg-prefix": (1, 1, FindPackagePrefix),
    "find-pkg-share": (1, 1, FindPackageShare),
    "param": (1, 2, lambda name, default=None: Parameter(name, default=default)),
}
