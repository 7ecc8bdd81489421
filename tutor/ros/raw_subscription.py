"""Topics at any rate: every message is taken, as bytes, and only what is shown is deserialised.

A thread waits until there is something, takes all of it, and hands it over in one batch; then it lets more gather for a
moment. So ten thousand messages a second cost a hundred wake-ups, not ten thousand.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rclpy.context import Context
from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.serialization import deserialize_message
from rclpy.subscription import Subscription

from tutor.ros.messages import interface_class
from tutor.ros.participant import OUR_PREFIX, create_node
from tutor.ros.qos import subscription_profile
from tutor.ros_model import QoS

DEPTH = 10_000
"""Messages that may wait until we take them: a second of a 10 kHz topic."""

GATHER_S = 0.01
"""How long messages gather between two wake-ups, in seconds."""

_MOST_AT_ONCE = 5_000
_WAIT_NS = 1_000_000_000


@dataclass(frozen=True, slots=True)
class Batch:
    """Messages of a topic in order of arrival: all source timestamps (s) and sequence numbers, the last one's bytes."""

    stamps: list[float]
    numbers: list[int | None]
    newest: bytes


class RawSubscription:
    """Subscriptions whose messages are taken in a thread of their own. Methods may be called from any thread."""

    def __init__(self, context: Context) -> None:
        self._context = context
        # In no executor: only we take its messages.
        self._node = create_node(context, f"{OUR_PREFIX}_raw_subscription")
        self._subscriptions: dict[str, tuple[Subscription, Callable[[Batch], None]]] = {}
        self._requests: deque[Callable[[], None]] = deque()
        self._guard = _rclpy.GuardCondition(context.handle)
        self._closing = False
        self._thread = threading.Thread(target=self._run, name="raw_subscription", daemon=True)
        self._thread.start()

    def subscribe(self, topic: str, type_name: str, qos: QoS, on_batch: Callable[[Batch], None]) -> None:
        """Take the messages of a topic; `on_batch` is called in the subscription's thread. Raises UnknownType."""
        message_type = interface_class(type_name)
        profile = subscription_profile(qos, DEPTH)

        def resubscribe() -> None:
            self._destroy(topic)
            subscription = self._node.create_subscription(message_type, topic, _unused_callback, profile, raw=True)
            self._subscriptions[topic] = (subscription, on_batch)

        self._request(resubscribe)

    def unsubscribe(self, topic: str) -> None:
        """Destroy a topic's subscription."""
        self._request(lambda: self._destroy(topic))

    def close(self) -> None:
        """Destroy all subscriptions and end the thread. The context must still be valid."""
        self._closing = True
        self._guard.trigger_guard_condition()
        self._thread.join(2.0)

    def _request(self, action: Callable[[], None]) -> None:
        self._requests.append(action)
        self._guard.trigger_guard_condition()

    def _destroy(self, topic: str) -> None:
        if found := self._subscriptions.pop(topic, None):
            self._node.destroy_subscription(found[0])

    def _run(self) -> None:
        try:
            while not self._closing and self._context.ok():
                while self._requests:
                    self._requests.popleft()()
                if not self._wait():
                    continue
                for subscription, on_batch in list(self._subscriptions.values()):
                    if (batch := _take_all(subscription)) is not None:
                        on_batch(batch)
                time.sleep(GATHER_S)  # the pace of taking, not a wait for anything
        finally:
            for topic in list(self._subscriptions):
                self._destroy(topic)
            self._node.destroy_node()

    def _wait(self) -> bool:
        """Wait for a message or a request. Returns whether there are subscriptions."""
        handles = [subscription.handle for subscription, _ in self._subscriptions.values()]
        # A new one each time, so that it holds no handle longer than the wait.
        waited = _rclpy.WaitSet(len(handles), 1, 0, 0, 0, 0, self._context.handle)
        waited.clear_entities()
        for handle in handles:
            waited.add_subscription(handle)
        waited.add_guard_condition(self._guard)
        waited.wait(_WAIT_NS)
        return bool(handles)


def deserialize(type_name: str, message: bytes) -> Any:
    """Deserialise a message. Raises UnknownType."""
    return deserialize_message(message, interface_class(type_name))


def _take_all(subscription: Subscription) -> Batch | None:
    stamps: list[float] = []
    numbers: list[int | None] = []
    newest = b""
    take, message_type = subscription.handle.take_message, subscription.msg_type
    with subscription.handle:
        while len(stamps) < _MOST_AT_ONCE and (taken := take(message_type, True)) is not None:
            newest, info = taken
            stamps.append(info["source_timestamp"] * 1e-9)
            numbers.append(info["publication_sequence_number"])
    return Batch(stamps, numbers, newest) if stamps else None


def _unused_callback(message: Any) -> None:
    raise AssertionError("no executor takes these messages")
