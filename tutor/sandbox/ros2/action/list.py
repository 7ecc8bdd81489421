"""`ros2 action list`."""

from __future__ import annotations

import argparse

from tutor.sandbox.ros2.action.names import actions
from tutor.sandbox.ros2.joining import joined


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[-t] [-c]."""
    parser.add_argument("-t", "--show-types", action="store_true", help="the types as well")
    parser.add_argument("-c", "--count-actions", action="store_true", help="only how many actions there are")


def main(arguments: argparse.Namespace) -> None:
    """Print the actions."""
    with joined(arguments) as domain:
        domain.complete()
        found = actions(domain)
    if arguments.count_actions:
        print(len(found))
        return
    for name, types in found:
        print(f"{name} [{', '.join(types)}]" if arguments.show_types else name)
