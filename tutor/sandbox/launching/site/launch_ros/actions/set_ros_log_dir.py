"""Where the nodes that follow log."""

from __future__ import annotations

import os.path
from typing import Any

from launch.action import Action
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


def _current(context: LaunchContext) -> str:
    home = context.environment.get("ROS_HOME") or os.path.expanduser("~/.ros")
    return context.environment.get("ROS_LOG_DIR") or os.path.join(home, "log")


class SetROSLogDir(Action):
    """Processes started from here on, in this scope, have another ROS_LOG_DIR; a relative one is below the last."""

    def __init__(self, new_log_dir: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._log_dir = normalize_to_list_of_substitutions(new_log_dir)

    @property
    def log_dir(self) -> list[Substitution]:
        return self._log_dir

    def execute(self, context: LaunchContext) -> None:
        folder = perform_substitutions(context, self._log_dir)
        context.environment["ROS_LOG_DIR"] = os.path.join(_current(context), folder)
