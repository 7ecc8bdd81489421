"""`ros2 action info`."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from tutor.bundled_ros.ros2.action.names import action_names
from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.bundled_ros.ros2.node.names import nodes
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.bundled_ros.ros2.topic.names import full_name

NodesAndTypes = list[tuple[str, Sequence[str]]]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[-t] [-c] ACTION."""
    complete_with(parser.add_argument("action_name", help="the action, such as /fibonacci"), action_names)
    parser.add_argument("-t", "--show-types", action="store_true", help="the types as well")
    parser.add_argument("-c", "--count", action="store_true", help="only how many clients and servers there are")


def main(arguments: argparse.Namespace) -> None:
    """Print the nodes with a client or a server of the action. Raises CommandError for an invalid name."""
    from rclpy.action.graph import get_action_client_names_and_types_by_node, get_action_server_names_and_types_by_node

    name = arguments.action_name
    with join_domain(arguments) as domain:
        expanded = full_name(domain, name)
        domain.wait_for_discovery()
        clients = _nodes_with_action(domain, expanded, get_action_client_names_and_types_by_node)
        servers = _nodes_with_action(domain, expanded, get_action_server_names_and_types_by_node)
    print(f"Action: {name}")
    for title, found in (("clients", clients), ("servers", servers)):
        print(f"Action {title}: {len(found)}")
        for node, types in () if arguments.count else found:
            print(f"    {node} [{', '.join(types)}]" if arguments.show_types else f"    {node}")


def _nodes_with_action(
    domain: Domain, action: str, query: Callable[..., Iterable[tuple[str, Sequence[str]]]]
) -> NodesAndTypes:
    found: NodesAndTypes = []
    for node in nodes(domain, hidden=True):
        actions: dict[str, Any] = dict(query(domain.node, node.name, node.namespace))
        if action in actions:
            found.append((node.full, actions[action]))
    return found
