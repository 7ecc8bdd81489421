"""Parts of a path, joined."""

from __future__ import annotations

import os.path
from collections.abc import Iterable
from pathlib import Path

from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities.normalize_to_list_of_substitutions_impl import normalize_to_list_of_substitutions
from ..utilities.perform_substitutions_impl import perform_substitutions


class PathJoinSubstitution(Substitution):
    """The parts, each a text, a path, a substitution or several of them, joined as os.path.join does.

    `path / part` is the path with one more part.
    """

    def __init__(self, substitutions: SomeSubstitutionsType | Iterable[SomeSubstitutionsType]) -> None:
        parts = [substitutions] if isinstance(substitutions, str | Path | Substitution) else substitutions
        self._parts = [normalize_to_list_of_substitutions(part) for part in parts]

    @property
    def substitutions(self) -> list[Substitution]:
        return [item for part in self._parts for item in part]

    def describe(self) -> str:
        return f"PathJoin('{' + '.join(item.describe() for item in self.substitutions)}')"

    def perform(self, context: LaunchContext) -> str:
        return os.path.join(*[perform_substitutions(context, part) for part in self._parts])

    def __truediv__(self, additional_path: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([*self._parts, additional_path])


class PathSubstitution(PathJoinSubstitution):
    """One path, to which parts can be added: `PathSubstitution(FindPackageShare('demo')) / 'config' / 'x.yaml'`."""

    def __init__(self, path: SomeSubstitutionsType) -> None:
        super().__init__([path])


class FoundPath(PathSubstitution):
    """The base of substitutions that find a folder."""

    def __init__(self) -> None:
        super().__init__(self)
