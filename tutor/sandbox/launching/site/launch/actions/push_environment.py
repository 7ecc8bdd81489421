"""The start of a scope of environment variables."""

from __future__ import annotations

from ..action import Action
from ..launch_context import LaunchContext


class PushEnvironment(Action):
    """What is set from here on is forgotten at the next PopEnvironment."""

    def execute(self, context: LaunchContext) -> None:
        context._push_environment()
