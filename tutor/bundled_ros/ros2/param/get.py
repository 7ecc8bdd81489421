"""`ros2 param get`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.param.client import (
    add_node_arguments,
    add_timeout,
    parameter_client,
    parameter_names,
)
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.errors import CommandError
from tutor.ros_model import PARAMETER_TYPES


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[--hide-type] NODE PARAMETER."""
    add_node_arguments(parser)
    complete_with(parser.add_argument("parameter_name", help="the parameter"), parameter_names)
    parser.add_argument("--hide-type", action="store_true", help="the value only")
    add_timeout(parser)


def main(arguments: argparse.Namespace) -> None:
    """Print the value. Raises CommandError if there is no such node or parameter."""
    from rclpy.parameter import parameter_value_to_python

    with parameter_client(arguments) as node:
        values = node.values([arguments.parameter_name])
    if not values:
        raise CommandError("Parameter not set")
    value, kind = parameter_value_to_python(values[0]), PARAMETER_TYPES[values[0].type]
    if arguments.hide_type:
        print(value)
    elif value is None:
        print("Parameter not set.")
    else:
        print(f"{kind.removesuffix(' array').capitalize()} {'values are' if 'array' in kind else 'value is'}: {value}")
