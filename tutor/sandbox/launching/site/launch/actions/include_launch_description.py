"""Another launch file."""

from __future__ import annotations

import os.path
from collections.abc import Iterable, Sequence
from typing import Any

from ..action import Action
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..launch_description_source import LaunchDescriptionSource
from ..launch_description_sources.any_launch_description_source import AnyLaunchDescriptionSource
from ..some_substitutions_type import SomeSubstitutionsType
from ..utilities.normalize_to_list_of_substitutions_impl import normalize_to_list_of_substitutions
from ..utilities.perform_substitutions_impl import perform_substitutions
from .set_launch_configuration import SetLaunchConfiguration


class IncludeLaunchDescription(Action):
    """Visits another launch description in place, after setting the launch arguments.

    It is no scope: the arguments, and whatever the other file sets, stay set afterwards.
    """

    def __init__(
        self,
        launch_description_source: LaunchDescriptionSource | SomeSubstitutionsType,
        *,
        launch_arguments: Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        if isinstance(launch_description_source, LaunchDescriptionSource):
            self._source = launch_description_source
        else:
            self._source = AnyLaunchDescriptionSource(launch_description_source)
        self._arguments = tuple(launch_arguments or ())

    @property
    def launch_description_source(self) -> LaunchDescriptionSource:
        return self._source

    @property
    def launch_arguments(self) -> Sequence[tuple[SomeSubstitutionsType, SomeSubstitutionsType]]:
        return self._arguments

    def get_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        description = self._source.try_get_launch_description_without_context()
        return [] if description is None else [description]

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity]:
        description = self._source.get_launch_description(context)
        path = os.path.abspath(self._source.location)
        folder = os.path.dirname(path) if os.path.exists(path) else self._source.location
        context.extend_locals({"current_launch_file_path": path, "current_launch_file_directory": folder})
        given = self._argument_names(context)
        for argument, includes in description.get_launch_arguments_with_include_launch_description_actions():
            if argument._conditionally_included or argument.default_value is not None:
                continue
            for include in includes or ():
                given += include._argument_names_without_context()
            if argument.name not in given:
                raise RuntimeError(
                    f"Included launch description missing required argument '{argument.name}' "
                    f"(description: '{argument.description}'), given: [{', '.join(given)}]"
                )
        return [*(SetLaunchConfiguration(name, value) for name, value in self._arguments), description]

    def _argument_names(self, context: LaunchContext) -> list[str]:
        names = (normalize_to_list_of_substitutions(name) for name, _ in self._arguments)
        return [perform_substitutions(context, name) for name in names]

    def _argument_names_without_context(self) -> list[str]:
        try:
            return self._argument_names(LaunchContext())
        except Exception:
            return []  # a name that is known only when the file runs
