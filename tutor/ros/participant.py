"""How we join a domain: with a participant of our own, and nodes that are told from the learner's."""

from __future__ import annotations

import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from tutor.ros.environment import NO_LOG_FILES

OUR_PREFIX = "_ros_tutor"
"""Names of our own nodes begin with this: hidden, as those of ros2cli are."""


def join_domain(domain_id: int) -> Context:
    """A new participant on this domain. Signals are left alone, and no log files are written."""
    context = Context()
    rclpy.init(
        args=[*NO_LOG_FILES], context=context, domain_id=domain_id, signal_handler_options=SignalHandlerOptions.NO
    )
    return context


def create_node(context: Context, name: str) -> Node:
    """A node without topics and services of its own."""
    return rclpy.create_node(
        name, context=context, use_global_arguments=False, enable_rosout=False, start_parameter_services=False
    )
