"""Transitions of lifecycle nodes, one after the other."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from launch.action import Action
from launch.actions.emit_event import EmitEvent
from launch.actions.opaque_function import OpaqueFunction
from launch.actions.register_event_handler import RegisterEventHandler
from launch.event import Event
from launch.event_handler import BaseEventHandler, EventHandler
from launch.launch_context import LaunchContext
from launch.logging import get_logger
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from ..event_handlers.on_state_transition import OnStateTransition
from ..events.lifecycle.change_state import ChangeState
from ..events.lifecycle.state_transition import StateTransition
from ..events.matchers.matches_node_name import matches_node_name

GOALS = {
    1: ("configuring", "inactive"),
    2: ("cleaningup", "unconfigured"),
    3: ("activating", "active"),
    4: ("deactivating", "inactive"),
    5: ("shuttingdown", "finalized"),
    6: ("shuttingdown", "finalized"),
    7: ("shuttingdown", "finalized"),
}
"""For each transition the state that it passes through, and the one that it leads to."""


class LifecycleTransition(Action):
    """Has each node make the transitions: the next one when it has reached the goal of the one before."""

    def __init__(
        self,
        *,
        lifecycle_node_names: Sequence[SomeSubstitutionsType],
        transition_ids: Sequence[int | SomeSubstitutionsType],
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        if not transition_ids:
            raise ValueError("No transition_ids provided.")
        if not lifecycle_node_names:
            raise ValueError("No lifecycle_node_names provided.")
        self._names = [normalize_to_list_of_substitutions(name) for name in lifecycle_node_names]
        self._ids = [
            normalize_to_list_of_substitutions(str(number) if isinstance(number, int) else number)
            for number in transition_ids
        ]

    def execute(self, context: LaunchContext) -> list[Action]:
        numbers = [_number(perform_substitutions(context, number)) for number in self._ids]
        actions: list[Action] = []
        for parts in self._names:
            actions += _of_node(perform_substitutions(context, parts), numbers)
        return actions


def _number(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise ValueError(f"expected integer for lifecycle transition, got {text}") from None


def _of_node(name: str, numbers: Sequence[int]) -> list[Action]:
    is_it = matches_node_name(name)
    handlers: list[BaseEventHandler] = []

    def forget(context: LaunchContext, reason: str = "") -> None:
        if reason:
            get_logger("launch_ros.actions.lifecycle_transition").info(
                f"Stopping transitions for {name} because '{reason}'"
            )
        for handler in handlers:
            if handler in context._event_handlers:
                context.unregister_event_handler(handler)

    def has_failed(event: Event) -> bool:
        return isinstance(event, StateTransition) and is_it(event.action) and event.goal_state == "errorprocessing"

    changes = [EmitEvent(event=ChangeState(lifecycle_node_matcher=is_it, transition_id=number)) for number in numbers]
    for number, then in zip(numbers, [*changes[1:], OpaqueFunction(function=forget)], strict=True):
        handlers.append(OnStateTransition(matcher=_reaches(is_it, *GOALS[number]), entities=[then], handle_once=True))
    failed = OpaqueFunction(function=forget, kwargs={"reason": "error occured during transitions"})
    handlers.append(EventHandler(matcher=has_failed, entities=[failed], handle_once=True))
    return [*map(RegisterEventHandler, handlers), changes[0]]


def _reaches(is_it: Any, start: str, goal: str) -> Any:
    def reaches(event: Event) -> bool:
        return (
            isinstance(event, StateTransition)
            and is_it(event.action)
            and (event.start_state, event.goal_state) == (start, goal)
        )

    return reaches
