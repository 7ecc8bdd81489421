"""A ROS node with a lifecycle."""

from __future__ import annotations

import importlib
import threading
from collections.abc import Sequence
from typing import Any

from launch.actions.opaque_function import OpaqueFunction
from launch.event_handler import BaseEventHandler, EventHandler
from launch.launch_context import LaunchContext
from launch.launch_description_entity import LaunchDescriptionEntity
from launch.logging import get_logger
from launch.some_substitutions_type import SomeSubstitutionsType

from ..events.lifecycle.change_state import STATES, TRANSITIONS, ChangeState
from ..events.lifecycle.state_transition import StateTransition
from ..ros_adapters import get_ros_node
from .node import Node

_LOOK_EVERY_S = 0.2
"""How often a wait for the node is looked at, in case the launch ends meanwhile."""


class LifecycleNode(Node):
    """Starts a node, emits StateTransition when it changes its state, and has ChangeState events change it."""

    def __init__(self, *, name: SomeSubstitutionsType, namespace: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self._current_state = STATES[0]
        self._client: Any = None
        self._subscription: Any = None

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        self._find_names(context)
        if self.UNSPECIFIED_NODE_NAME in self.node_name:
            raise RuntimeError("node_name unexpectedly incomplete for lifecycle node")
        messages = importlib.import_module("lifecycle_msgs.msg")
        services = importlib.import_module("lifecycle_msgs.srv")
        node = get_ros_node(context)

        def on_transition(message: Any) -> None:
            self._current_state = STATES[message.goal_state.id]
            event = StateTransition(action=self, msg=message)
            context.asyncio_loop.call_soon_threadsafe(context.emit_event_sync, event)

        topic = f"{self.node_name}/transition_event"
        self._subscription = node.create_subscription(messages.TransitionEvent, topic, on_transition, 10)
        self._client = node.create_client(services.ChangeState, f"{self.node_name}/change_state")
        context.register_event_handler(self._on_change_state(services.ChangeState.Request))
        return super().execute(context)

    def _on_change_state(self, request_type: Any) -> BaseEventHandler:
        def ask(context: LaunchContext) -> None:
            event = context.locals.event
            if not event.lifecycle_node_matcher(self):
                return
            request = request_type()
            request.transition.id = event.transition_id
            asked = context.asyncio_loop.run_in_executor(None, self._change_state, request, context)
            context.add_completion_future(asked)

        return EventHandler(
            matcher=lambda event: isinstance(event, ChangeState), entities=[OpaqueFunction(function=ask)]
        )

    def _change_state(self, request: Any, context: LaunchContext) -> None:
        """Call the node's service, in a thread of its own."""
        logger = get_logger("launch_ros.actions.lifecycle_node")
        service = self._client.srv_name
        while not self._client.wait_for_service(timeout_sec=_LOOK_EVERY_S):
            if context.is_shutdown:
                logger.warning(f"Abandoning wait for the '{service}' service, due to shutdown.")
                return
        answered = threading.Event()
        answer = self._client.call_async(request)
        answer.add_done_callback(lambda _: answered.set())
        while not answered.wait(_LOOK_EVERY_S):
            if context.is_shutdown:
                logger.warning(f"Abandoning wait for the '{service}' service response, due to shutdown.")
                answer.cancel()
                return
        if not answer.result().success:
            name = TRANSITIONS[request.transition.id]
            logger.error(f"Failed to make transition '{name}' for LifecycleNode '{self.node_name}'")
