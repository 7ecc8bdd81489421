"""`ros2 param delete`."""

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
    """NODE PARAMETER."""
    add_node_arguments(parser)
    complete_with(parser.add_argument("parameter_name", help="the parameter"), parameter_names)
    add_timeout(parser)


def main(arguments: argparse.Namespace) -> None:
    """Delete the parameter. If the node rejects that, its reason goes to stderr, and the exit code is still 0."""
    from rcl_interfaces.msg import Parameter

    with parameter_client(arguments) as node:
        results = node.set([Parameter(name=arguments.parameter_name)])  # a value of type NOT_SET deletes the parameter
    print_results([("Deleted parameter successfully|Deleting parameter failed", result) for result in results])
