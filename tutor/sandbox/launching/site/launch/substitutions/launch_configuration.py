"""The value of a launch configuration."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities.normalize_to_list_of_substitutions_impl import normalize_to_list_of_substitutions
from ..utilities.perform_substitutions_impl import perform_substitutions
from .substitution_failure import SubstitutionFailure


class LaunchConfiguration(Substitution):
    """An argument's value, or that of SetLaunchConfiguration; `default` where there is none."""

    def __init__(self, variable_name: SomeSubstitutionsType, *, default: Any = None) -> None:
        self._name = normalize_to_list_of_substitutions(variable_name)
        self._default = None if default is None else normalize_to_list_of_substitutions(_texts(default))

    @property
    def variable_name(self) -> list[Substitution]:
        return self._name

    def describe(self) -> str:
        return f"LaunchConfig({' + '.join(part.describe() for part in self._name)})"

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self._name)
        if name in context.launch_configurations:
            return context.launch_configurations[name]  # type: ignore[no-any-return]  # a list, for some of launch_ros
        if self._default is None:
            raise SubstitutionFailure(f"launch configuration '{name}' does not exist")
        return perform_substitutions(context, self._default)


def _texts(default: Any) -> list[str | Substitution]:
    """A default may be anything that has a text, or several."""
    items = [default] if isinstance(default, str) or not isinstance(default, Iterable) else list(default)
    return [item if isinstance(item, str | Substitution) else str(item) for item in items]
