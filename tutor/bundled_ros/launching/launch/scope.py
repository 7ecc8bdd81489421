"""Actions that change the state later actions see: arguments, launch configurations and the environment."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

from tutor.bundled_ros.launching.launch.base import LaunchContext, SomeSubstitutionsType, Substitution
from tutor.bundled_ros.launching.launch.entities import Action
from tutor.bundled_ros.launching.launch.logs import get_logger
from tutor.bundled_ros.launching.launch.values import (
    normalize_to_list_of_substitutions,
    normalize_typed_substitution,
    perform_substitutions,
    perform_typed_substitution,
)


class DeclareLaunchArgument(Action):
    """Declares a launch configuration that is set by `name:=value` on the command line, or else by its default."""

    def __init__(
        self,
        name: str,
        *,
        default_value: SomeSubstitutionsType | None = None,
        description: str | None = None,
        choices: Sequence[str] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._name = name
        self._default = None if default_value is None else normalize_to_list_of_substitutions(default_value)
        self._choices = choices
        self._description = _describe(description, choices)
        self._conditionally_included = False
        if choices is not None and len(choices) == 0:
            self._fail("Provided choices arg is empty. Use None to ignore the choice list.")
        if choices is not None and isinstance(default_value, str) and default_value not in choices:
            self._fail(f'Provided default_value "{default_value}" is not in provided choices "{choices}".')

    @property
    def name(self) -> str:
        return self._name

    @property
    def default_value(self) -> list[Substitution] | None:
        return self._default

    @property
    def description(self) -> str:
        return self._description

    def execute(self, context: LaunchContext) -> None:
        configurations = context.launch_configurations
        if self._name not in configurations:
            if self._default is None:
                get_logger("launch.actions.declare_launch_argument").error(
                    f'Required launch argument "{self._name}" (description: "{self._description}") was not provided'
                )
                raise RuntimeError(f'Required launch argument "{self._name}" was not provided.')
            configurations[self._name] = perform_substitutions(context, self._default)
        value = configurations[self._name]
        if self._choices is not None and value not in self._choices:
            self._fail(
                f'Argument "{self._name}" provided value "{value}" is not valid. Valid options are: {self._choices}'
            )

    @staticmethod
    def _fail(message: str) -> None:
        get_logger("launch.actions.declare_launch_argument").error(message)
        raise RuntimeError(message)


def _describe(description: str | None, choices: Sequence[str] | None) -> str:
    if description is None:
        return "no description given" if choices is None else f"One of: {choices}"
    if choices is None:
        return description
    return f"{description}{'' if description.endswith('.') else '.'} Valid choices are: {choices}"


class _OfName(Action):
    """An action on the launch configuration or environment variable of this name."""

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._name = normalize_to_list_of_substitutions(name)


class _Assignment(_OfName):
    """An action that gives a value to a launch configuration or environment variable."""

    def __init__(self, name: SomeSubstitutionsType, value: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(name, **kwargs)
        self._value = normalize_to_list_of_substitutions(value)


class SetLaunchConfiguration(_Assignment):
    """Sets a launch configuration for the rest of the current scope."""

    def execute(self, context: LaunchContext) -> None:
        name = perform_substitutions(context, self._name)
        context.launch_configurations[name] = perform_substitutions(context, self._value)


class UnsetLaunchConfiguration(_OfName):
    """Removes a launch configuration."""

    def execute(self, context: LaunchContext) -> None:
        context.launch_configurations.pop(perform_substitutions(context, self._name), None)


class PushLaunchConfigurations(Action):
    """Saves the launch configurations, to be restored by PopLaunchConfigurations."""

    def execute(self, context: LaunchContext) -> None:
        context._push_launch_configurations()


class PopLaunchConfigurations(Action):
    """Restores the launch configurations saved by the last PushLaunchConfigurations."""

    def execute(self, context: LaunchContext) -> None:
        context._pop_launch_configurations()


class ResetLaunchConfigurations(Action):
    """Removes all launch configurations but the given ones, whose values may still refer to the old ones."""

    def __init__(
        self,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._kept = dict(launch_configurations or {})

    def execute(self, context: LaunchContext) -> None:
        kept = {
            perform_substitutions(context, normalize_to_list_of_substitutions(name)): _expand(context, value)
            for name, value in self._kept.items()
        }
        context.launch_configurations.clear()
        context.launch_configurations.update(kept)


def _expand(context: LaunchContext, value: Any) -> Any:
    """Expand a text or a substitution. Anything else, such as a list, stays unchanged, as in the original."""
    if not isinstance(value, str | Substitution):
        return value
    return perform_substitutions(context, normalize_to_list_of_substitutions(value))


class SetEnvironmentVariable(_Assignment):
    """Sets an environment variable for processes started later in the current scope."""

    def execute(self, context: LaunchContext) -> None:
        name = perform_substitutions(context, self._name)
        context.environment[name] = perform_substitutions(context, self._value)


class AppendEnvironmentVariable(_Assignment):
    """Appends (with `prepend`: prepends) a value to an environment variable, or sets the variable if it is unset."""

    def __init__(
        self,
        name: SomeSubstitutionsType,
        value: SomeSubstitutionsType,
        prepend: bool | SomeSubstitutionsType = False,
        separator: SomeSubstitutionsType = os.pathsep,
        **kwargs: Any,
    ) -> None:
        super().__init__(name, value, **kwargs)
        self._prepend = normalize_typed_substitution(prepend, bool)
        self._separator = normalize_to_list_of_substitutions(separator)

    def execute(self, context: LaunchContext) -> None:
        name = perform_substitutions(context, self._name)
        parts = [perform_substitutions(context, self._value)]
        if name in context.environment:
            position = 1 if perform_typed_substitution(context, self._prepend, bool) else 0
            parts.insert(position, context.environment[name])
        context.environment[name] = perform_substitutions(context, self._separator).join(parts)


class UnsetEnvironmentVariable(_OfName):
    """Removes an environment variable for processes started later."""

    def execute(self, context: LaunchContext) -> None:
        context.environment.pop(perform_substitutions(context, self._name), None)


class PushEnvironment(Action):
    """Saves the environment, to be restored by PopEnvironment."""

    def execute(self, context: LaunchContext) -> None:
        context._push_environment()


class PopEnvironment(Action):
    """Restores the environment saved by the last PushEnvironment."""

    def execute(self, context: LaunchContext) -> None:
        context._pop_environment()


class ResetEnvironment(Action):
    """Restores the environment that the launch was started with."""

    def execute(self, context: LaunchContext) -> None:
        context._reset_environment()
