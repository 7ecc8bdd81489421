"""A remapping for the nodes that follow."""

from __future__ import annotations

from typing import Any

from launch.action import Action
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


class SetRemap(Action):
    """Nodes that follow in this scope get this remapping, before their own."""

    def __init__(self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._src = normalize_to_list_of_substitutions(src)
        self._dst = normalize_to_list_of_substitutions(dst)

    @property
    def src(self) -> list[Substitution]:
        return self._src

    @property
    def dst(self) -> list[Substitution]:
        return self._dst

    def execute(self, context: LaunchContext) -> None:
        rule = (perform_substitutions(context, self._src), perform_substitutions(context, self._dst))
        # The list itself is shared, not copied, by an inner scope that finds it: so does the original.
        context.launch_configurations.setdefault("ros_remaps", []).append(rule)
