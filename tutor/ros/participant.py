"""How we join a domain: with a separate context, and so our own participant, and nodes with our prefix."""

from __future__ import annotations

import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from tutor.ros.environment import NO_LOG_FILES

OUR_PREFIX = "_ros_tutor"
"""The prefix of our node names. The underscore hides them, as ros2cli does with its own."""


def new_context(domain_id: int | None = None) -> Context:
    """Join a domain, by default ROS_DOMAIN_ID. Installs no signal handlers and writes no log files."""
    context = Context()
    rclpy.init(
        args=[*NO_LOG_FILES], context=context, domain_id=domain_id, signal_handler_options=SignalHandlerOptions.NO
    )
    return context


def create_node(context: Context, name: str) -> Node:
    """Create a node without a /rosout publisher and parameter services."""
    return rclpy.create_node(
        name, context=context, use_global_arguments=False, enable_rosout=False, start_parameter_services=False
    )
