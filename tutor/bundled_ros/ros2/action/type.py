"""`ros2 action type`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.action.names import action_names, actions
from tutor.bundled_ros.ros2.domain import join_domain
from tutor.bundled_ros.ros2.parsing import complete_with


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """ACTION."""
    complete_with(parser.add_argument("action_name", help="the action, such as /fibonacci"), action_names)


def main(arguments: argparse.Namespace) -> int:
    """Print the action's types. Return 1 if there is no such action."""
    with join_domain(arguments) as domain:
        types = domain.find(lambda: dict(actions(domain)).get(arguments.action_name))
    for type_name in types or ():
        print(type_name)
    return 0 if types else 1
