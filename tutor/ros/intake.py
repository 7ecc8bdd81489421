"""One topic of a learner's, taken as bytes: how large a message is, is known before anything is made of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.serialization import deserialize_message

from tutor.ros.messages import interface_class, placeholder_message
from tutor.ros.qos import subscription_profile
from tutor.ros_model import QoS

DEEP = 1000
"""Queue depth of our subscriptions: a default-QoS subscriber can lose a burst that this one gets whole."""

WAITING_BYTES = 8_000_000
"""What may wait until it is taken, at most: of large messages, fewer wait. One that is larger itself is the last."""

READABLE_BYTES = 2_000_000
"""A larger message is counted, with its time and its size, and not looked into."""

MOST_SAMPLES = 20_000
"""A topic is no longer listened to after this many samples: a flood must not exhaust us."""

MOST_BYTES = 8_000_000
"""Nor after this many bytes."""

_RECEIVED = 8
"""Bytes that are received and not kept count as a byte for this many."""


class Intake:
    """A subscription, whose messages are taken in the thread of the node's executor.

    `take(message, source_time)` is given each message and the time (s) at which it was sent; it gives what it costs to
    keep it, in bytes. Where a message is too large to be looked into, or is none of its type, its texts say so, and its
    arrays are empty.
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
        self._depth = DEEP
        self._take = take
        self._messages = self._kept = 0
        self._subscription = self._subscribe()

    def leave(self) -> None:
        """Take no more messages. Called in the executor's thread."""
        self._node.destroy_subscription(self._subscription)

    def _subscribe(self) -> Any:
        # rclpy gives the message's info to a callback that takes two arguments; its annotations know one only.
        callback: Any = self._receive
        qos = subscription_profile(self._requested, self._depth)
        return self._node.create_subscription(
            self._type, self._topic, callback, qos, callback_group=self._group, raw=True
        )

    def _receive(self, data: bytes, info: Any) -> None:
        size = len(data)
        self._messages += 1
        self._kept += self._take(self._read(data), info["source_timestamp"] * 1e-9)
        if size > READABLE_BYTES:
            self._kept += size // _RECEIVED
        if self._messages >= MOST_SAMPLES or self._kept > MOST_BYTES or size > WAITING_BYTES:
            self.leave()
        elif size * self._depth > WAITING_BYTES:
            self.leave()
            self._depth = max(1, WAITING_BYTES // size)
            self._requested = replace(
                self._requested, durability="volatile"
            )  # the messages kept for late subscribers have come
            self._subscription = self._subscribe()

    def _read(self, data: bytes) -> Any:
        if len(data) > READABLE_BYTES:
            return placeholder_message(
                self._type, f"(a message of {len(data) / 1e6:.1f} MB, too large to be looked into)"
            )
        try:
            return deserialize_message(data, self._type)
        except Exception:  # whatever it is that a learner sends as bytes
            return placeholder_message(self._type, f"({len(data)} bytes that are no {self._type.__name__})")
