"""`ros2 action list`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.action.names import actions
from tutor.bundled_ros.ros2.domain import join_domain


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[-t] [-c]."""
    parser.add_argument("-t", "--show-types", action="store_true", help="the types as well")
    parser.add_argument("-c", "--count-actions", action="store_true", help="only how many actions there are")


def main(arguments: argparse.Namespace) -> None:
    """Print the actions."""
    with join_domain(arguments) as domain:
        domain.wait_for_discovery()
        found = actions(domain)
    if arguments.count_actions:
        print(len(found))
        return
    for name, types in found:
        print(f"{name} [{', '.join(types)}]" if arguments.show_types else name)
