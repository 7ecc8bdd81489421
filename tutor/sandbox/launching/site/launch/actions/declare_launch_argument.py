"""An argument of the launch file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..action import Action
from ..launch_context import LaunchContext
from ..logging import get_logger
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities.normalize_to_list_of_substitutions_impl import normalize_to_list_of_substitutions
from ..utilities.perform_substitutions_impl import perform_substitutions


class DeclareLaunchArgument(Action):
    """A launch configuration that `name:=value` on the command line sets, or else the default."""

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

    @property
    def choices(self) -> Sequence[str] | None:
        return self._choices

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
