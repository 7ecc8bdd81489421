"""Subscribes to a learner's topic and takes messages as bytes, so that their size is known before decoding."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.serialization import deserialize_message

from tutor.ros.interfaces import interface_class
from tutor.ros.messages import RECEIVED_PER_KEPT_BYTE, placeholder_message
from tutor.ros.qos import to_rclpy
from tutor.ros_model import QoS

QUEUE_DEPTH = 1000
"""Queue depth of our subscriptions, so that a burst arrives whole that a default-QoS subscriber would lose in part."""

MAX_QUEUED_BYTES = 8_000_000
"""Most bytes in the queue: it is made shorter for large messages. A single message above this is the last one taken."""

MAX_READABLE_BYTES = 2_000_000
"""A larger message is counted, with its time and size, but not decoded."""

MAX_SAMPLES = 20_000
"""We unsubscribe from a topic after this many samples, so that a flood cannot exhaust our memory."""

MAX_BYTES = 8_000_000
"""We also unsubscribe after keeping this many bytes."""


class Intake:
    """A bounded subscription.

    In the executor's thread, `take(message, source_time)` gets each message and the time (s) when it was sent; it
    returns the memory cost of what it keeps, in bytes. For a message that is too large to decode, or not of the topic's
    type, it gets a placeholder whose strings say so and whose arrays are empty.
    """

    def __init__(
        self,
        node: Node,
        topic: str,
        type_name: str,
        requested: QoS,
        group: CallbackGroup,
        take: Callable[[Any, float], int],
    ) -> None:
        """Raises UnknownType."""
        self._node = node
        self._topic = topic
        self._type = interface_class(type_name)
        self._requested = requested
        self._group = group
        self._depth = QUEUE_DEPTH
        self._take = take
        self._received = self._kept_bytes = 0
        self._subscription = self._subscribe()

    def unsubscribe(self) -> None:
        """Unsubscribe. Called in the executor's thread."""
        self._node.destroy_subscription(self._subscription)

    def _subscribe(self) -> Any:
        # rclpy also passes the message info to a callback with two parameters, but its annotations allow only one.
        callback: Any = self._receive
        qos = to_rclpy(self._requested, self._depth)
        return self._node.create_subscription(
            self._type, self._topic, callback, qos, callback_group=self._group, raw=True
        )

    def _receive(self, data: bytes, info: Any) -> None:
        size = len(data)
        self._received += 1
        self._kept_bytes += self._take(self._read(data), info["source_timestamp"] * 1e-9)
        if size > MAX_READABLE_BYTES:
            self._kept_bytes += size // RECEIVED_PER_KEPT_BYTE
        if self._received >= MAX_SAMPLES or self._kept_bytes > MAX_BYTES or size > MAX_QUEUED_BYTES:
            self.unsubscribe()
        elif size * self._depth > MAX_QUEUED_BYTES:
            self.unsubscribe()
            self._depth = max(1, MAX_QUEUED_BYTES // size)
            # Volatile: the messages stored for late subscribers have already arrived.
            self._requested = replace(self._requested, durability="volatile")
            self._subscription = self._subscribe()

    def _read(self, data: bytes) -> Any:
        if len(data) > MAX_READABLE_BYTES:
            return placeholder_message(self._type, f"(a message of {len(data) / 1e6:.1f} MB, too large to decode)")
        try:
            return deserialize_message(data, self._type)
        except Exception:  # a learner may send arbitrary bytes
            return placeholder_message(self._type, f"({len(data)} bytes that are not a valid {self._type.__name__})")
