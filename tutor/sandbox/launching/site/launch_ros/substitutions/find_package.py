"""Where a package is."""

from __future__ import annotations

from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.substitutions.path_join_substitution import FoundPath
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from .. import packages


class FindPackage(FoundPath):
    """A folder of a package."""

    def __init__(self, package: SomeSubstitutionsType) -> None:
        super().__init__()
        self._package = normalize_to_list_of_substitutions(package)

    @property
    def package(self) -> list[Substitution]:
        return self._package

    def find(self, package_name: str) -> str:
        """The folder of the package of this name."""
        raise NotImplementedError

    def describe(self) -> str:
        return f"{type(self).__name__}(pkg={' + '.join(part.describe() for part in self._package)})"

    def perform(self, context: LaunchContext) -> str:
        return self.find(perform_substitutions(context, self._package))


class FindPackagePrefix(FindPackage):
    """The folder that it is installed in."""

    def find(self, package_name: str) -> str:
        return packages.find_prefix(package_name)


class FindPackageShare(FindPackage):
    """Its share folder: launch files, parameter files."""

    def find(self, package_name: str) -> str:
        return packages.find_share(package_name)
