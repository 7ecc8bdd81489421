"""`ros2 node`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from typing import Any

from tutor.bundled_ros.ros2.arguments import STRATEGY, count
from tutor.bundled_ros.ros2.domain import join_domain
from tutor.bundled_ros.ros2.names import NamesAndTypes, complete_nodes, nodes
from tutor.bundled_ros.ros2.parsing import Group, Verb, Verbs, argument, flag
from tutor.errors import CommandError
from tutor.ros_model import NodeName, is_hidden


def _list(arguments: argparse.Namespace) -> None:
    """Print the nodes."""
    with join_domain(arguments) as domain:
        domain.wait_for_discovery()
        names = sorted(node.full for node in nodes(domain, hidden=arguments.all))
    if arguments.count:
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


def _info(arguments: argparse.Namespace) -> None:
    """Print a node's topics, services and actions. Raises CommandError if no node has exactly this name."""
    wanted, hidden = arguments.node_name, arguments.include_hidden
    with join_domain(arguments) as domain:
        domain.wait_for_discovery()
        number = [node.full for node in nodes(domain, hidden=hidden)].count(wanted)
        if not number:
            raise CommandError(f"Unable to find node '{wanted}'")
        if number > 1:
            print(
                f'There are {number} nodes in the graph with the exact name "{wanted}". '
                "You are seeing information about only one of them.",
                file=sys.stderr,
            )
        print(wanted)
        for title, query in _sections(domain.node):
            print(f"  {title}:")
            found = [(name, types) for name, types in query(*NodeName.parse(wanted)) if hidden or not is_hidden(name)]
            print("\n".join(f"    {name}: {', '.join(types)}" for name, types in found))


def _sections(node: Any) -> Iterator[tuple[str, Callable[[str, str], NamesAndTypes]]]:
    from rclpy.action import graph

    yield "Subscribers", node.get_subscriber_names_and_types_by_node
    yield "Publishers", node.get_publisher_names_and_types_by_node
    yield "Service Servers", node.get_service_names_and_types_by_node
    yield "Service Clients", node.get_client_names_and_types_by_node
    yield "Action Servers", lambda *name: graph.get_action_server_names_and_types_by_node(node, *name)
    yield "Action Clients", lambda *name: graph.get_action_client_names_and_types_by_node(node, *name)


_VERBS: Verbs = {
    "info": (
        "Show what a node publishes, subscribes to, offers and calls",
        Verb(
            _info,
            *STRATEGY,
            argument("node_name", complete=complete_nodes, help="the node's full name, such as /talker"),
            flag("--include-hidden", help="hidden topics, services and actions as well"),
        ),
    ),
    "list": (
        "List the nodes",
        Verb(_list, *STRATEGY, flag("-a", "--all", help="hidden nodes as well"), count("nodes")),
    ),
}
GRAMMAR = {"node": Group(_VERBS)}
