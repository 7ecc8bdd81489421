"""Events of lifecycle nodes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tutor.bundled_ros.launching.launch.base import Event
from tutor.bundled_ros.launching.launch.entities import Action


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Return a matcher for the node with this name, which is in the root namespace unless it starts with a slash."""
    full = node_name if node_name.startswith("/") else f"/{node_name}"
    return lambda action: bool(action.node_name == full)


TRANSITIONS = {
    0: "TRANSITION_CREATE",
    1: "TRANSITION_CONFIGURE",
    2: "TRANSITION_CLEANUP",
    3: "TRANSITION_ACTIVATE",
    4: "TRANSITION_DEACTIVATE",
    5: "TRANSITION_UNCONFIGURED_SHUTDOWN",
    6: "TRANSITION_INACTIVE_SHUTDOWN",
    7: "TRANSITION_ACTIVE_SHUTDOWN",
    8: "TRANSITION_DESTROY",
}

STATES = {
    0: "PRIMARY_STATE_UNKNOWN",
    1: "PRIMARY_STATE_UNCONFIGURED",
    2: "PRIMARY_STATE_INACTIVE",
    3: "PRIMARY_STATE_ACTIVE",
    4: "PRIMARY_STATE_FINALIZED",
    10: "TRANSITION_STATE_CONFIGURING",
    11: "TRANSITION_STATE_CLEANINGUP",
    12: "TRANSITION_STATE_SHUTTINGDOWN",
    13: "TRANSITION_STATE_ACTIVATING",
    14: "TRANSITION_STATE_DEACTIVATING",
    15: "TRANSITION_STATE_ERRORPROCESSING",
}


class ChangeState(Event):
    """Requests a transition of lifecycle_msgs/msg/Transition from the lifecycle nodes that the matcher accepts.

    Raises ValueError for an unknown transition id.
    """

    name = "launch_ros.events.lifecycle.ChangeState"
    valid_transitions = TRANSITIONS
    valid_states = STATES

    def __init__(self, *, lifecycle_node_matcher: Callable[[Any], bool], transition_id: int) -> None:
        super().__init__()
        if transition_id not in TRANSITIONS:
            listed = ", ".join(f"{name}: {number}" for number, name in TRANSITIONS.items())
            raise ValueError(f"given transition_id of '{transition_id}', expected one of {{{listed}}}")
        self._matcher = lifecycle_node_matcher
        self._transition_id = transition_id

    @property
    def lifecycle_node_matcher(self) -> Callable[[Any], bool]:
        return self._matcher

    @property
    def transition_id(self) -> int:
        return self._transition_id


class StateTransition(Event):
    """A lifecycle node changes its state. `msg` is a lifecycle_msgs/msg/TransitionEvent."""

    name = "launch_ros.events.lifecycle.StateTransition"

    def __init__(self, *, action: Action, msg: Any) -> None:
        super().__init__()
        self._action = action
        self._msg = msg

    @property
    def action(self) -> Action:
        return self._action

    @property
    def msg(self) -> Any:
        return self._msg

    @property
    def transition(self) -> str:
        return str(self._msg.transition.label)

    @property
    def start_state(self) -> str:
        return str(self._msg.start_state.label)

    @property
    def goal_state(self) -> str:
        return str(self._msg.goal_state.label)
