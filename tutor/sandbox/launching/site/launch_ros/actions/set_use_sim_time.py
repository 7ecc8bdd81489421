"""The clock of the launch itself."""

from __future__ import annotations

from typing import Any

from launch.action import Action
from launch.launch_context import LaunchContext


class SetUseSimTime(Action):
    """Sets `use_sim_time` on the launch's own node, and on no other. Here it has none, so nothing is done."""

    def __init__(self, value: bool, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._value = value

    @property
    def value(self) -> bool:
        return self._value

    def execute(self, context: LaunchContext) -> None:
        return None
