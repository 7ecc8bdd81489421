"""A parameter for the nodes that follow."""

from __future__ import annotations

from typing import Any

from launch.action import Action
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.utilities import normalize_to_list_of_substitutions

from ..utilities.evaluate_parameters import evaluate_parameter_dict
from ..utilities.normalize_parameters import normalize_parameter_dict


class SetParameter(Action):
    """Nodes that follow in this scope get this parameter; their own count more."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._parameter = normalize_parameter_dict({tuple(normalize_to_list_of_substitutions(name)): value})

    @property
    def name(self) -> Any:
        return next(iter(self._parameter))

    @property
    def value(self) -> Any:
        return next(iter(self._parameter.values()))

    def execute(self, context: LaunchContext) -> None:
        evaluated = evaluate_parameter_dict(context, self._parameter)
        context.launch_configurations.setdefault("global_params", []).extend(evaluated.items())
