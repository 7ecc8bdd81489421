"""`ros2 node info`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from typing import Any

from tutor.bundled_ros.ros2.domain import add_strategy_arguments, join_domain
from tutor.bundled_ros.ros2.node.names import node_names, nodes
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.errors import CommandError
from tutor.ros_model import NodeName

NamesAndTypes = Callable[[str, str], Sequence[tuple[str, Sequence[str]]]]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[--include-hidden] NODE."""
    add_strategy_arguments(parser)
    complete_with(parser.add_argument("node_name", help="the node's full name, such as /talker"), node_names)
    parser.add_argument("--include-hidden", action="store_true", help="hidden topics, services and actions as well")


def main(arguments: argparse.Namespace) -> None:
    """Print a node's topics, services and actions. Raises CommandError if no node has exactly this name."""
    wanted, hidden = arguments.node_name, arguments.include_hidden
    with join_domain(arguments) as domain:
        domain.wait_for_discovery()
        count = [node.full for node in nodes(domain, hidden=hidden)].count(wanted)
        if not count:
            raise CommandError(f"Unable to find node '{wanted}'")
        if count > 1:
            print(
                f'There are {count} nodes in the graph with the exact name "{wanted}". '
                "You are seeing information about only one of them.",
                file=sys.stderr,
            )
        print(wanted)
        for title, query in _sections(domain.node):
            print(f"  {title}:")
            found = [(name, types) for name, types in query(*NodeName.parse(wanted)) if hidden or not _is_hidden(name)]
            print("\n".join(f"    {name}: {', '.join(types)}" for name, types in found))


def _sections(node: Any) -> list[tuple[str, NamesAndTypes]]:
    methods = {
        "Subscribers": "get_subscriber_names_and_types_by_node",
        "Publishers": "get_publisher_names_and_types_by_node",
        "Service Servers": "get_service_names_and_types_by_node",
        "Service Clients": "get_client_names_and_types_by_node",
    }
    from rclpy.action import graph

    return [
        *((title, getattr(node, name)) for title, name in methods.items()),
        ("Action Servers", lambda *name: graph.get_action_server_names_and_types_by_node(node, *name)),
        ("Action Clients", lambda *name: graph.get_action_client_names_and_types_by_node(node, *name)),
    ]


def _is_hidden(name: str) -> bool:
    return any(part.startswith("_") for part in name.split("/"))
