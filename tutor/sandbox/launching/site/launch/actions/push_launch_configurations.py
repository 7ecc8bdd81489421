"""The start of a scope of launch configurations."""

from __future__ import annotations

from ..action import Action
from ..launch_context import LaunchContext


class PushLaunchConfigurations(Action):
    """What is set from here on is forgotten at the next PopLaunchConfigurations."""

    def execute(self, context: LaunchContext) -> None:
        context._push_launch_configurations()
