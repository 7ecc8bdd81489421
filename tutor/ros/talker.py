"""Our publisher on the learner's domain, in a separate participant."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

from rclpy.event_handler import QoSPublisherEventType
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.publisher import Publisher

from tutor.judge.trace import Sample
from tutor.ros.fields import assign
from tutor.ros.interfaces import interface_class
from tutor.ros.participant import OUR_PREFIX, create_node, new_context
from tutor.ros.qos import to_rclpy
from tutor.ros_model import QoS, TopicEndpoint

DEPTH = 10
"""The queue depth of ROS's demo talkers."""

DEFAULT_QOS = QoS()
"""What they offer: reliable and volatile."""


class Talker:
    """Implements `Publisher` of `tutor.judge.peers` on real DDS. Raises UnknownType if the type is not installed."""

    def __init__(self, domain_id: int, topic: str, type_name: str, qos: QoS = DEFAULT_QOS, depth: int = DEPTH) -> None:
        """`qos`: what it offers, of which only reliability and durability are taken. `depth`: how many it keeps."""
        self._type: Any = interface_class(type_name)
        self._context = new_context(domain_id)
        name = f"{OUR_PREFIX}_talker"
        self._node = create_node(self._context, name)
        self._publisher: Publisher = self._node.create_publisher(self._type, topic, to_rclpy(qos, depth))
        with self._publisher.handle:
            self._matched: Any = rclpy_implementation.EventHandle(
                self._publisher.handle, QoSPublisherEventType.RCL_PUBLISHER_MATCHED
            )
        self._endpoint = TopicEndpoint(topic, type_name, f"/{name}", qos)

    @property
    def endpoint(self) -> TopicEndpoint:
        return self._endpoint

    @property
    def subscribers(self) -> int:
        return self._publisher.get_subscription_count()

    @property
    def matches(self) -> int:
        # Taken without an executor: DDS counts every match, also those between two calls.
        with self._matched:
            return int(self._matched.take_event().total_count)

    def publish(self, message: Mapping[str, Any]) -> Sample:
        filled = assign(self._type(), message)
        now = time.time()
        self._publisher.publish(filled)
        return Sample(self._endpoint.topic, dict(message), now, now)

    def close(self) -> None:
        """Leave the graph. Idempotent."""
        if self._context.ok():
            self._matched.destroy_when_not_in_use()
            self._node.destroy_node()
            self._context.try_shutdown()
