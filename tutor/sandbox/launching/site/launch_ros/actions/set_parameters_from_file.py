"""Parameters from a file for the nodes that follow."""

from __future__ import annotations

from typing import Any

from launch.action import Action
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


class SetParametersFromFile(Action):
    """Nodes that follow in this scope get the parameters in the file."""

    def __init__(self, filename: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._file = normalize_to_list_of_substitutions(filename)

    def execute(self, context: LaunchContext) -> None:
        path = perform_substitutions(context, self._file)
        context.launch_configurations.setdefault("global_params", []).append(path)
