"""Actions that yield other actions, LogInfo and Shutdown."""

from __future__ import annotations

import os.path
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from .._entities import Action, LaunchDescriptionEntity, SomeSubstitutionsType, Substitution
from ..events import ProcessExited
from ..events import Shutdown as ShutdownEvent
from ..launch_context import LaunchContext
from ..launch_description_sources import AnyLaunchDescriptionSource, LaunchDescriptionSource
from ..logging import get_logger
from ..utilities import ensure_argument_type, normalize_to_list_of_substitutions, perform_substitutions
from ._events import EmitEvent
from ._scope import (
    PopEnvironment,
    PopLaunchConfigurations,
    PushEnvironment,
    PushLaunchConfigurations,
    ResetEnvironment,
    ResetLaunchConfigurations,
    SetLaunchConfiguration,
)


class LogInfo(Action):
    """Logs a message as `[INFO] [launch.user]`."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._msg = normalize_to_list_of_substitutions(msg)

    @property
    def msg(self) -> list[Substitution]:
        return self._msg

    def execute(self, context: LaunchContext) -> None:
        get_logger("launch.user").info(perform_substitutions(context, self._msg))


class OpaqueFunction(Action):
    """Calls a function with the context and the arguments; the entities that it returns are visited next."""

    def __init__(
        self,
        *,
        function: Callable[..., Sequence[LaunchDescriptionEntity] | None],
        args: Iterable[Any] | None = None,
        kwargs: dict[str, Any] | None = None,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        if not callable(function):
            raise TypeError(f"OpaqueFunction expected a callable for 'function', got '{type(function)}'")
        ensure_argument_type(args, (Iterable, type(None)), "args", "OpaqueFunction")
        ensure_argument_type(kwargs, (dict, type(None)), "kwargs", "OpaqueFunction")
        self._function = function
        self._args = list(args or ())
        self._kwargs = dict(kwargs or {})

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        return self._function(context, *self._args, **self._kwargs)


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


class IncludeLaunchDescription(Action):
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
            return []  # a name that is not known until the file runs


class Shutdown(EmitEvent):
    """Shuts the launch down: all processes are asked to end."""

    def __init__(self, *, reason: str = "reason not given", **kwargs: Any) -> None:
        super().__init__(event=ShutdownEvent(reason=reason), **kwargs)

    def execute(self, context: LaunchContext) -> None:
        event = context.get_locals_as_dict().get("event")
        if isinstance(event, ProcessExited):
            get_logger("launch").info(f"process[{event.process_name}] was required: shutting down launched system")
        super().execute(context)
