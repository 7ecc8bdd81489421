"""A publisher of ours on the learner's domain, as a talker is: a participant of its own, that comes and goes."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.signals import SignalHandlerOptions

from tutor.judge.trace import Endpoint, Sample
from tutor.ros.environment import NO_LOG_FILES
from tutor.ros.messages import interface_class, set_fields
from tutor.ros.observer import OUR_PREFIX

DEPTH = 10
"""The queue depth of the talkers that ROS brings along; their QoS is the default one, reliable and volatile."""


class TopicFeed:
    """The `Feed` of `tutor.judge.bench`, on real DDS. Raises UnknownType for a type that this ROS does not have."""

    def __init__(self, domain_id: int, topic: str, type_name: str) -> None:
        self._type: Any = interface_class(type_name)
        self._context = Context()
        rclpy.init(
            args=[*NO_LOG_FILES],
            context=self._context,
            domain_id=domain_id,
            signal_handler_options=SignalHandlerOptions.NO,
        )
        name = f"{OUR_PREFIX}_feed"
        self._node: Node = rclpy.create_node(
            name,
            context=self._context,
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
        )
        self._publisher: Publisher = self._node.create_publisher(self._type, topic, DEPTH)
        self._endpoint = Endpoint(topic, type_name, f"/{name}", "reliable", "volatile")

    @property
    def endpoint(self) -> Endpoint:
        return self._endpoint

    @property
    def subscribers(self) -> int:
        return self._publisher.get_subscription_count()

    def publish(self, message: Mapping[str, Any]) -> Sample:
        filled = set_fields(self._type(), message)
        now = time.time()
        self._publisher.publish(filled)
        return Sample(self._endpoint.topic, dict(message), now, now)

    def close(self) -> None:
        """Take the publisher, its node and its participant out of the graph. Safe to call twice."""
        if self._context.ok():
            self._node.destroy_node()
            self._context.try_shutdown()
