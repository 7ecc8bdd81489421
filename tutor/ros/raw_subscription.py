"""Subscribes to topics of any rate: takes every message as bytes, so that only those shown are deserialized.

A thread waits for messages, takes all of them, and passes them on in one batch. Then it lets more gather for a moment,
so 10,000 messages per second cost 100 wake-ups instead of 10,000.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any

from rclpy.context import Context
from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.serialization import deserialize_message
from rclpy.subscription import Subscription

from tutor.ros.batches import DEPTH, Received, never_called, take_all, wait_for_any
from tutor.ros.interfaces import interface_class
from tutor.ros.participant import OUR_PREFIX, create_node
from tutor.ros.qos import to_rclpy
from tutor.ros_model import QoS

GATHER_S = 0.01
"""How long messages gather between two wake-ups."""

_WAIT_S = 1.0


class RawSubscription:
    """Subscriptions that share a dedicated thread for taking messages. Methods may be called from any thread."""

    def __init__(self, context: Context) -> None:
        self._context = context
        # Not added to any executor: only our thread takes its messages.
        self._node = create_node(context, f"{OUR_PREFIX}_raw_subscription")
        self._subscriptions: dict[str, tuple[Subscription, Callable[[list[Received]], None]]] = {}
        self._requests: deque[Callable[[], None]] = deque()
        self._wake_condition = _rclpy.GuardCondition(context.handle)
        self._closing = False
        self._thread = threading.Thread(target=self._run, name="raw_subscription", daemon=True)
        self._thread.start()

    def subscribe(self, topic: str, type_name: str, qos: QoS, on_batch: Callable[[list[Received]], None]) -> None:
        """Subscribe to a topic; `on_batch` is called in the dedicated thread. Raises UnknownType."""
        message_type = interface_class(type_name)
        profile = to_rclpy(qos, DEPTH)

        def resubscribe() -> None:
            self._destroy(topic)
            subscription = self._node.create_subscription(message_type, topic, never_called, profile, raw=True)
            self._subscriptions[topic] = (subscription, on_batch)

        self._request(resubscribe)

    def unsubscribe(self, topic: str) -> None:
        """Destroy a topic's subscription."""
        self._request(lambda: self._destroy(topic))

    def close(self) -> None:
        """Destroy all subscriptions and end the thread. The context must still be valid."""
        self._closing = True
        self._wake_condition.trigger_guard_condition()
        self._thread.join(2.0)

    def _request(self, action: Callable[[], None]) -> None:
        self._requests.append(action)
        self._wake_condition.trigger_guard_condition()

    def _destroy(self, topic: str) -> None:
        if found := self._subscriptions.pop(topic, None):
            self._node.destroy_subscription(found[0])

    def _run(self) -> None:
        try:
            while not self._closing and self._context.ok():
                while self._requests:
                    self._requests.popleft()()
                subscriptions = [subscription for subscription, _ in self._subscriptions.values()]
                wait_for_any(self._context, subscriptions, _WAIT_S, self._wake_condition)
                if not subscriptions:
                    continue
                for subscription, on_batch in list(self._subscriptions.values()):
                    if batch := take_all(subscription, raw=True)[0]:
                        on_batch(batch)
                time.sleep(GATHER_S)  # lets a batch gather; not a wait for any condition
        finally:
            for topic in list(self._subscriptions):
                self._destroy(topic)
            self._node.destroy_node()


def deserialize(type_name: str, message: bytes) -> Any:
    """Deserialize a message. Raises UnknownType."""
    return deserialize_message(message, interface_class(type_name))
