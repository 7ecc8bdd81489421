"""Actions made of others: groups and included launch files."""

from __future__ import annotations

import os.path
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from tutor.bundled_ros.launching.launch.base import LaunchContext, LaunchDescriptionEntity, SomeSubstitutionsType
from tutor.bundled_ros.launching.launch.description import AnyLaunchDescriptionSource, Include, LaunchDescriptionSource
from tutor.bundled_ros.launching.launch.entities import Action
from tutor.bundled_ros.launching.launch.scope import (
    PopEnvironment,
    PopLaunchConfigurations,
    PushEnvironment,
    PushLaunchConfigurations,
    ResetEnvironment,
    ResetLaunchConfigurations,
    SetLaunchConfiguration,
)
from tutor.bundled_ros.launching.launch.values import normalize_to_list_of_substitutions, perform_substitutions


class GroupAction(Action):
    """Visits actions after setting the given launch configurations.

    If scoped, changes to launch configurations and environment end with the group. Without forwarding, the actions
    start with the given launch configurations only, and with the launch's initial environment. If not scoped, the
    actions behave as if there were no group.
    """

    def __init__(
        self,
        actions: Iterable[LaunchDescriptionEntity],
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        self._actions = actions
        self._scoped = scoped
        self._forwarding = forwarding
        self._configurations = dict(launch_configurations or {})
        self._entities: list[LaunchDescriptionEntity] | None = None

    def get_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        if self._entities is None:
            self._entities = self._scoped_entities()
        return self._entities

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity]:
        return self.get_sub_entities()

    def _scoped_entities(self) -> list[LaunchDescriptionEntity]:
        settings = [SetLaunchConfiguration(name, value) for name, value in self._configurations.items()]
        if not self._scoped:
            return [*settings, *self._actions]
        reset = [ResetEnvironment(), ResetLaunchConfigurations(self._configurations)]
        return [
            PushLaunchConfigurations(),
            PushEnvironment(),
            *(settings if self._forwarding else reset),
            *self._actions,
            PopEnvironment(),
            PopLaunchConfigurations(),
        ]


class IncludeLaunchDescription(Include):
    """Visits another launch description in place, after setting the launch arguments.

    This is not a scope: the arguments, and whatever the other file sets, stay set afterwards.
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

    def get_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        description = self._source.try_get_launch_description_without_context()
        return [] if description is None else [description]

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity]:
        description = self._source.get_launch_description(context)
        path = os.path.abspath(self._source.location)
        folder = os.path.dirname(path) if os.path.exists(path) else self._source.location
        context.extend_locals({"current_launch_file_path": path, "current_launch_file_directory": folder})
        given = self._argument_names(context)
        for argument, includes in description.arguments_and_includes():
            if argument._conditionally_included or argument.default_value is not None:
                continue
            for include in includes or ():
                given += include.argument_names_without_context()
            if argument.name not in given:
                raise RuntimeError(
                    f"Included launch description missing required argument '{argument.name}' "
                    f"(description: '{argument.description}'), given: [{', '.join(given)}]"
                )
        return [*(SetLaunchConfiguration(name, value) for name, value in self._arguments), description]

    def _argument_names(self, context: LaunchContext) -> list[str]:
        names = (normalize_to_list_of_substitutions(name) for name, _ in self._arguments)
        return [perform_substitutions(context, name) for name in names]

    def argument_names_without_context(self) -> list[str]:
        try:
            return self._argument_names(LaunchContext())
        except Exception:
            return []  # a name that is not known until the file runs
