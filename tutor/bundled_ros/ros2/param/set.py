"""`ros2 param set`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.param.client import (
    add_node_arguments,
    add_timeout,
    parameter_client,
    parameter_names,
    print_results,
)
from tutor.bundled_ros.ros2.parsing import complete_with


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """NODE PARAMETER VALUE."""
    add_node_arguments(parser)
    complete_with(parser.add_argument("parameter_name", help="the parameter"), parameter_names)
    parser.add_argument("value", help="its new value, as YAML: 5.0 is a double, 5 an integer, true a boolean")
    add_timeout(parser)


def main(arguments: argparse.Namespace) -> None:
    """Set the parameter. If the node rejects that, its reason goes to stderr, and the exit code is still 0."""
    from rcl_interfaces.msg import Parameter
    from rclpy.parameter import get_parameter_value

    parameter = Parameter(name=arguments.parameter_name, value=get_parameter_value(arguments.value))
    with parameter_client(arguments) as node:
        results = node.set([parameter])
    print_results([("Set parameter successful|Setting parameter failed", result) for result in results])
