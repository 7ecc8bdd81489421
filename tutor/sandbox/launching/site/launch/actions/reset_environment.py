"""The environment as it was."""

from __future__ import annotations

from ..action import Action
from ..launch_context import LaunchContext


class ResetEnvironment(Action):
    """Brings back the environment that the launch was started with."""

    def execute(self, context: LaunchContext) -> None:
        context._reset_environment()
