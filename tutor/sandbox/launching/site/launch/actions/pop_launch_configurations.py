"""The end of a scope of launch configurations."""

from __future__ import annotations

from ..action import Action
from ..launch_context import LaunchContext


class PopLaunchConfigurations(Action):
    """Brings back the launch configurations of the last PushLaunchConfigurations."""

    def execute(self, context: LaunchContext) -> None:
        context._pop_launch_configurations()
