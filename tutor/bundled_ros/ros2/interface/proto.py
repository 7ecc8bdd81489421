"""`ros2 interface proto`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.completion import types
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.errors import CommandError, UnknownType
from tutor.ros.interfaces import find_interface
from tutor.ros.yaml_format import to_yaml

_PART = {"msg": "", "srv": "Request", "action": "Goal"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[--no-quotes] TYPE."""
    complete_with(parser.add_argument("type", help="the type, such as geometry_msgs/msg/Twist"), types())
    parser.add_argument("--no-quotes", action="store_true", help="without the quotation marks around it")


def main(arguments: argparse.Namespace) -> None:
    """Print a message, request or goal with its default values. Raises CommandError."""
    parts = arguments.type.split("/")
    if len(parts) != 3 or parts[1] not in _PART:
        raise CommandError(f"Invalid name '{arguments.type}'. Expected three parts separated by '/'")
    try:
        found = find_interface(arguments.type, parts[1])
    except UnknownType as error:
        raise CommandError(f"Unknown type '{arguments.type}'") from error
    text = to_yaml((getattr(found, _PART[parts[1]]) if _PART[parts[1]] else found)())
    print(text if arguments.no_quotes else f'"{text}"')
