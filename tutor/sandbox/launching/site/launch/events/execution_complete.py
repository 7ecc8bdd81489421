"""An action has ended."""

from __future__ import annotations

from ..action import Action
from ..event import Event


class ExecutionComplete(Event):
    """Nothing of the action is going on any more."""

    name = "launch.events.ExecutionComplete"

    def __init__(self, *, action: Action) -> None:
        self._action = action

    @property
    def action(self) -> Action:
        return self._action
