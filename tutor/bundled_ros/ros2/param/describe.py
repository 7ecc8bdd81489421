"""`ros2 param describe`."""

from __future__ import annotations

import argparse
from typing import Any

from tutor.bundled_ros.ros2.param.client import (
    add_node_arguments,
    add_timeout,
    parameter_client,
    parameter_names,
)
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.ros_model import PARAMETER_TYPES


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """NODE PARAMETER ..."""
    add_node_arguments(parser)
    complete_with(parser.add_argument("parameter_names", nargs="+", help="the parameters"), parameter_names)
    add_timeout(parser)


def main(arguments: argparse.Namespace) -> None:
    """Print the parameters' descriptors; undeclared parameters are skipped."""
    with parameter_client(arguments) as node:
        for descriptor in node.descriptors(arguments.parameter_names):
            _print(descriptor)


def _print(descriptor: Any) -> None:
    print(f"Parameter name: {descriptor.name}")
    print(f"  Type: {PARAMETER_TYPES[descriptor.type]}")
    if descriptor.description:
        print(f"  Description: {descriptor.description}")
    print("  Constraints:")
    if descriptor.read_only:
        print("    Read only: true")
    for allowed in [*descriptor.floating_point_range, *descriptor.integer_range][:1]:
        print(f"    Min value: {allowed.from_value}")
        print(f"    Max value: {allowed.to_value}")
        if allowed.step:
            print(f"    Step: {allowed.step}")
    if descriptor.additional_constraints:
        print(f"    Additional constraints: {descriptor.additional_constraints}")
