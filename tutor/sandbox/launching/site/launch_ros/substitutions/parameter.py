"""The value of a parameter that SetParameter has set."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.substitutions.substitution_failure import SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


class Parameter(Substitution):
    """The value as a text; the default, or SubstitutionFailure, where the parameter is not set in this scope."""

    def __init__(self, name: SomeSubstitutionsType, *, default: Any = None) -> None:
        self._name = normalize_to_list_of_substitutions(name)
        items = default if isinstance(default, Iterable) and not isinstance(default, str) else [default]
        texts = [item if isinstance(item, str | Substitution) else str(item) for item in items]
        self._default = None if default is None else normalize_to_list_of_substitutions(texts)

    @property
    def name(self) -> list[Substitution]:
        return self._name

    def describe(self) -> str:
        return f"Parameter(name={' + '.join(part.describe() for part in self._name)})"

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self._name)
        for item in context.launch_configurations.get("global_params") or ():
            if isinstance(item, tuple) and item[0] == name:
                return str(item[1])
        if self._default is None:
            raise SubstitutionFailure(f"parameter '{name}' not found")
        return perform_substitutions(context, self._default)
