"""The end of a scope of environment variables."""

from __future__ import annotations

from ..action import Action
from ..launch_context import LaunchContext


class PopEnvironment(Action):
    """Brings back the environment of the last PushEnvironment."""

    def execute(self, context: LaunchContext) -> None:
        context._pop_environment()
