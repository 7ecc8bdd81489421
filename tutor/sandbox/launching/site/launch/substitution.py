"""The base of all substitutions."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .launch_context import LaunchContext
    from .some_substitutions_type import SomeSubstitutionsType


class Substitution:
    """A text that is known only while the launch file runs."""

    def describe(self) -> str:
        return repr(self)

    def perform(self, context: LaunchContext) -> str:
        """The text, in this context."""
        raise NotImplementedError(f"{type(self).__name__} has no perform()")

    def __truediv__(self, other: SomeSubstitutionsType) -> Substitution:
        from .substitutions.path_join_substitution import PathJoinSubstitution

        return PathJoinSubstitution([self, other])

    def __rtruediv__(self, other: SomeSubstitutionsType) -> Substitution:
        from .substitutions.path_join_substitution import PathJoinSubstitution

        return PathJoinSubstitution([other, self])
