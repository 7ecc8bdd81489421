"""The command of a package's executable."""

from __future__ import annotations

import shlex

from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from .. import packages


class ExecutableInPackage(Substitution):
    """Its path; where it takes several words to run it, as the first item of a command it stands for all of them."""

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
        """The command, word by word."""
        executable = perform_substitutions(context, self._executable)
        return packages.find_executable(perform_substitutions(context, self._package), executable)

    def perform_name(self, context: LaunchContext) -> str:
        """The executable's name."""
        return perform_substitutions(context, self._executable)
