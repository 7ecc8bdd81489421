"""Lifecycle nodes, their transitions and the handler of transition events."""

from __future__ import annotations

import contextlib
import importlib
import os
import threading
from collections.abc import Callable, Sequence
from typing import Any

from tutor.bundled_ros.launching.launch.base import (
    BaseEventHandler,
    Event,
    LaunchContext,
    LaunchDescriptionEntity,
    SomeEntitiesType,
    SomeSubstitutionsType,
)
from tutor.bundled_ros.launching.launch.entities import Action, EventHandler
from tutor.bundled_ros.launching.launch.errors import refuse
from tutor.bundled_ros.launching.launch.flow import EmitEvent, OpaqueFunction, RegisterEventHandler
from tutor.bundled_ros.launching.launch.handlers import OnShutdown
from tutor.bundled_ros.launching.launch.logs import get_logger
from tutor.bundled_ros.launching.launch.values import normalize_to_list_of_substitutions, perform_substitutions
from tutor.bundled_ros.launching.launch_ros.lifecycle_events import (
    TRANSITIONS,
    ChangeState,
    StateTransition,
    matches_node_name,
)
from tutor.bundled_ros.launching.launch_ros.node import Node

_SHUTDOWN_POLL_S = 0.2
"""How often a wait for the node checks whether the launch is shutting down."""


class _OwnNode:
    """The launch's own node, in its own context, spun in a background thread."""

    def __init__(self) -> None:
        try:
            rclpy = importlib.import_module("rclpy")
            executors = importlib.import_module("rclpy.executors")
        except ImportError:
            refuse("a launch file with a ROS node of its own, where rclpy is missing,")
        self._context = rclpy.Context()
        rclpy.init(args=[], context=self._context)
        self.node = rclpy.create_node(f"launch_ros_{os.getpid()}", context=self._context)
        self._executor = executors.SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._shutdown_exception = executors.ExternalShutdownException
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()

    def _spin(self) -> None:
        with contextlib.suppress(self._shutdown_exception):
            self._executor.spin()

    def shutdown(self) -> None:
        """Destroy the node."""
        self._context.try_shutdown()
        self._thread.join()
        self._executor.shutdown()
        self.node.destroy_node()


def get_ros_node(context: LaunchContext) -> Any:
    """Return the launch's own node, created on the first call and shut down with the launch."""
    own: _OwnNode | None = context.get_locals_as_dict().get("ros_adapter")
    if own is None:
        made = own = _OwnNode()
        context.extend_globals({"ros_adapter": made})
        context.register_event_handler(OnShutdown(on_shutdown=lambda event, context: made.shutdown()))
    return own.node


class LifecycleNode(Node):
    """Starts a lifecycle node, emits StateTransition when its state changes, and applies ChangeState events to it."""

    def __init__(self, *, name: SomeSubstitutionsType, namespace: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self._client: Any = None
        self._subscription: Any = None

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        self._complete_command(context)
        if self.UNSPECIFIED_NODE_NAME in self.node_name:
            raise RuntimeError("node_name unexpectedly incomplete for lifecycle node")
        messages = importlib.import_module("lifecycle_msgs.msg")
        services = importlib.import_module("lifecycle_msgs.srv")
        node = get_ros_node(context)

        def on_transition(message: Any) -> None:
            event = StateTransition(action=self, msg=message)
            context.asyncio_loop.call_soon_threadsafe(context.emit_event_sync, event)

        topic = f"{self.node_name}/transition_event"
        self._subscription = node.create_subscription(messages.TransitionEvent, topic, on_transition, 10)
        self._client = node.create_client(services.ChangeState, f"{self.node_name}/change_state")
        context.register_event_handler(self._on_change_state(services.ChangeState.Request))
        return super().execute(context)

    def _on_change_state(self, request_type: Any) -> BaseEventHandler:
        def request_transition(context: LaunchContext) -> None:
            event = context.locals.event
            if not event.lifecycle_node_matcher(self):
                return
            request = request_type()
            request.transition.id = event.transition_id
            call = context.asyncio_loop.run_in_executor(None, self._change_state, request, context)
            context.add_completion_future(call)

        return EventHandler(
            matcher=lambda event: isinstance(event, ChangeState), entities=[OpaqueFunction(function=request_transition)]
        )

    def _change_state(self, request: Any, context: LaunchContext) -> None:
        """Call the node's change_state service; blocks, so it runs in an executor thread."""
        logger = get_logger("launch_ros.actions.lifecycle_node")
        service = self._client.srv_name
        while not self._client.wait_for_service(timeout_sec=_SHUTDOWN_POLL_S):
            if context.is_shutdown:
                logger.warning(f"Abandoning wait for the '{service}' service, due to shutdown.")
                return
        answered = threading.Event()
        answer = self._client.call_async(request)
        answer.add_done_callback(lambda _: answered.set())
        while not answered.wait(_SHUTDOWN_POLL_S):
            if context.is_shutdown:
                logger.warning(f"Abandoning wait for the '{service}' service response, due to shutdown.")
                answer.cancel()
                return
        if not answer.result().success:
            name = TRANSITIONS[request.transition.id]
            logger.error(f"Failed to make transition '{name}' for LifecycleNode '{self.node_name}'")


class OnStateTransition(EventHandler):
    """Handles transitions that match all given criteria (node, transition, start and goal), or only `matcher`."""

    def __init__(
        self,
        *,
        entities: SomeEntitiesType,
        target_lifecycle_node: LifecycleNode | None = None,
        transition: str | None = None,
        start_state: str | None = None,
        goal_state: str | None = None,
        matcher: Callable[[Event], bool] | None = None,
        **kwargs: Any,
    ) -> None:
        if target_lifecycle_node is not None and not isinstance(target_lifecycle_node, LifecycleNode):
            raise RuntimeError("OnStateTransition requires a 'LifecycleNode' action as the target")

        def matches(event: Event) -> bool:
            return (
                isinstance(event, StateTransition)
                and target_lifecycle_node in (None, event.action)
                and transition in (None, event.transition)
                and start_state in (None, event.start_state)
                and goal_state in (None, event.goal_state)
            )

        super().__init__(matcher=matcher or matches, entities=entities, **kwargs)
        self._target = target_lifecycle_node

    @property
    def handler_description(self) -> str:
        return "<actions>"

    @property
    def matcher_description(self) -> str:
        if self._target is None:
            return "event == StateTransition"
        return f"event == StateTransition and event.action == LifecycleNode({hex(id(self._target))})"


GOALS = {
    1: ("configuring", "inactive"),
    2: ("cleaningup", "unconfigured"),
    3: ("activating", "active"),
    4: ("deactivating", "inactive"),
    5: ("shuttingdown", "finalized"),
    6: ("shuttingdown", "finalized"),
    7: ("shuttingdown", "finalized"),
}
"""For each transition id, the intermediate state and the final state."""


class LifecycleTransition(Action):
    """Takes nodes through a sequence of transitions, each one after the goal of the previous is reached."""

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
        numbers = [_parse_transition_id(perform_substitutions(context, number)) for number in self._ids]
        actions: list[Action] = []
        for parts in self._names:
            actions += _transitions_of_node(perform_substitutions(context, parts), numbers)
        return actions


def _parse_transition_id(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise ValueError(f"expected integer for lifecycle transition, got {text}") from None


def _transitions_of_node(name: str, numbers: Sequence[int]) -> list[Action]:
    is_target = matches_node_name(name)
    handlers: list[BaseEventHandler] = []

    def stop_handling(context: LaunchContext, reason: str = "") -> None:
        if reason:
            get_logger("launch_ros.actions.lifecycle_transition").info(
                f"Stopping transitions for {name} because '{reason}'"
            )
        for handler in handlers:
            if handler in context._event_handlers:
                context.unregister_event_handler(handler)

    def has_failed(event: Event) -> bool:
        return isinstance(event, StateTransition) and is_target(event.action) and event.goal_state == "errorprocessing"

    changes = [
        EmitEvent(event=ChangeState(lifecycle_node_matcher=is_target, transition_id=number)) for number in numbers
    ]
    for number, next_action in zip(numbers, [*changes[1:], OpaqueFunction(function=stop_handling)], strict=True):
        handlers.append(
            OnStateTransition(matcher=_reaches(is_target, *GOALS[number]), entities=[next_action], handle_once=True)
        )
    on_failure = OpaqueFunction(function=stop_handling, kwargs={"reason": "error occured during transitions"})
    handlers.append(EventHandler(matcher=has_failed, entities=[on_failure], handle_once=True))
    return [*map(RegisterEventHandler, handlers), changes[0]]


def _reaches(is_target: Any, start: str, goal: str) -> Any:
    def reaches(event: Event) -> bool:
        return (
            isinstance(event, StateTransition)
            and is_target(event.action)
            and (event.start_state, event.goal_state) == (start, goal)
        )

    return reaches
