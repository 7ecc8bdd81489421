"""Publishes by hand for the learner, from a node that is visible in the graph like that of `ros2 topic pub`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rclpy.context import Context
from rclpy.node import Node
from rclpy.publisher import Publisher

from tutor.ros.fields import fill
from tutor.ros.interfaces import interface_class
from tutor.ros.participant import OUR_PREFIX, create_node

NODE_NAME = "published_by_hand"
_DEPTH = 10


class ManualPublisher:
    """Manages publishers on one node, which exists only while it has any."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._node: Node | None = None
        self._publishers: dict[str, tuple[Publisher, Any]] = {}

    def add(self, topic: str, type_name: str, values: Mapping[str, Any]) -> None:
        """Create a reliable publisher for this message; `values` maps field paths to values.

        Raises UnknownType, or ValueError with a one-line message if a value or the topic name is invalid.
        """
        message = fill(interface_class(type_name)(), values)
        self.remove(topic)
        if self._node is None:
            self._node = create_node(self._context, NODE_NAME)
        try:
            publisher = self._node.create_publisher(interface_class(type_name), topic, _DEPTH)
        except Exception as error:  # rclpy raises several kinds of exceptions for a bad name
            self._destroy_node_if_unused()
            raise ValueError(f"{topic} is not a valid topic name: {str(error).splitlines()[0]}") from error
        self._publishers[topic] = (publisher, message)

    def publish(self, topic: str) -> None:
        """Publish the message that was added for this topic."""
        publisher, message = self._publishers[topic]
        publisher.publish(message)

    def listeners(self, topic: str) -> int:
        """Return the number of subscriptions, not counting our own."""
        if self._node is None:
            return 0
        found = self._node.get_subscriptions_info_by_topic(topic)
        return sum(not subscription.node_name.startswith(OUR_PREFIX) for subscription in found)

    def is_connected(self, topic: str, ours: bool) -> bool:
        """Return whether every known subscription is matched and, with `ours`, one of them is our own."""
        publisher, _ = self._publishers[topic]
        known = self._node.get_subscriptions_info_by_topic(topic) if self._node is not None else []
        has_ours = any(subscription.node_name.startswith(OUR_PREFIX) for subscription in known)
        return 0 < len(known) <= publisher.get_subscription_count() and (has_ours or not ours)

    def remove(self, topic: str) -> None:
        """Remove the publisher of a topic."""
        if (found := self._publishers.pop(topic, None)) is not None and self._node is not None:
            self._node.destroy_publisher(found[0])
        self._destroy_node_if_unused()

    def _destroy_node_if_unused(self) -> None:
        if not self._publishers and self._node is not None:
            self._node.destroy_node()
            self._node = None

    def close(self) -> None:
        """Remove all publishers."""
        for topic in list(self._publishers):
            self.remove(topic)
