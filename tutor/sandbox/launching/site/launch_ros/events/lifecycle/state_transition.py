"""Another state."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from launch.event import Event

if TYPE_CHECKING:
    from ...actions.lifecycle_node import LifecycleNode


class StateTransition(Event):
    """A lifecycle node goes from one state into another: `msg` is a lifecycle_msgs/msg/TransitionEvent."""

    name = "launch_ros.events.lifecycle.StateTransition"

    def __init__(self, *, action: LifecycleNode, msg: Any) -> None:
        super().__init__()
        self._action = action
        self._msg = msg

    @property
    def action(self) -> LifecycleNode:
        return self._action

    @property
    def msg(self) -> Any:
        return self._msg

    @property
    def timestamp(self) -> int:
        return int(self._msg.timestamp)

    @property
    def transition(self) -> str:
        return str(self._msg.transition.label)

    @property
    def start_state(self) -> str:
        return str(self._msg.start_state.label)

    @property
    def goal_state(self) -> str:
        return str(self._msg.goal_state.label)
