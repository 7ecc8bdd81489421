"""ROS-specific substitutions."""

from __future__ import annotations

import shlex
from collections.abc import Iterable
from typing import Any

from launch._entities import SomeSubstitutionsType, Substitution, SubstitutionFailure
from launch.launch_context import LaunchContext
from launch.substitutions._lookup import FoundPath
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from . import packages

__all__ = ["ExecutableInPackage", "FindPackage", "FindPackagePrefix", "FindPackageShare", "Parameter"]


class FindPackage(FoundPath):
    """Base class of substitutions that find a package's folder."""

    def __init__(self, package: SomeSubstitutionsType) -> None:
        super().__init__()
        self._package = normalize_to_list_of_substitutions(package)

    @property
    def package(self) -> list[Substitution]:
        return self._package

    def find(self, package_name: str) -> str:
        """Return the folder of the package with this name."""
        raise NotImplementedError

    def describe(self) -> str:
        return f"{type(self).__name__}(pkg={' + '.join(part.describe() for part in self._package)})"

    def perform(self, context: LaunchContext) -> str:
        return self.find(perform_substitutions(context, self._package))


class FindPackagePrefix(FindPackage):
    """The prefix that a package is installed in."""

    def find(self, package_name: str) -> str:
        return packages.find_prefix(package_name)


class FindPackageShare(FindPackage):
    """A package's share folder, which holds its launch files and parameter files."""

    def find(self, package_name: str) -> str:
        return packages.find_share(package_name)


class ExecutableInPackage(Substitution):
    """An executable's path. As the first item of a command, it expands to all words needed to run the executable."""

    def __init__(self, executable: SomeSubstitutionsType, package: SomeSubstitutionsType) -> None:
        self._executable = normalize_to_list_of_substitutions(executable)
        self._package = normalize_to_list_of_substitutions(package)

    @property
    def executable(self) -> list[Substitution]:
        return self._executable

    @property
    def package(self) -> list[Substitution]:
        return self._package

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
        return packages.find_executable(perform_substitutions(context, self._package), executable)

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

    @property
    def name(self) -> list[Substitution]:
        return self._name

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
