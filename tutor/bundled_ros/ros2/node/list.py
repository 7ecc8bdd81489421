"""`ros2 node list`."""

from __future__ import annotations

import argparse
import sys

from tutor.bundled_ros.ros2.domain import add_strategy_arguments, join_domain
from tutor.bundled_ros.ros2.node.names import nodes


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[-a] [-c]."""
    add_strategy_arguments(parser)
    parser.add_argument("-a", "--all", action="store_true", help="hidden nodes as well")
    parser.add_argument("-c", "--count-nodes", action="store_true", help="only how many nodes there are")


def main(arguments: argparse.Namespace) -> None:
    """Print the nodes."""
    with join_domain(arguments) as domain:
        domain.wait_for_discovery()
        names = sorted(node.full for node in nodes(domain, hidden=arguments.all))
    if arguments.count_nodes:
        print(len(names))
        return
    if len(set(names)) < len(names):
        print(
            "WARNING: Be aware that there are nodes in the graph that share an exact name, "
            "which can have unintended side effects.",
            file=sys.stderr,
        )
    for name in names:
        print(name)
