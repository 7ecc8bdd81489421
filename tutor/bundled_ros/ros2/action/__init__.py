"""`ros2 action`."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence

from tutor.bundled_ros.ros2.arguments import SHOW_TYPES, count
from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.bundled_ros.ros2.names import ACTIONS, NamesAndTypes, full_name, nodes
from tutor.bundled_ros.ros2.parsing import Group, Verb, Verbs, flag


def _info(arguments: argparse.Namespace) -> None:
    """Print the nodes with a client or a server of the action. Raises CommandError for an invalid name."""
    from rclpy.action.graph import get_action_client_names_and_types_by_node, get_action_server_names_and_types_by_node

    name = arguments.action_name
    with join_domain(arguments) as domain:
        full = full_name(domain, name)
        domain.wait_for_discovery()
        clients = _nodes_with_action(domain, full, get_action_client_names_and_types_by_node)
        servers = _nodes_with_action(domain, full, get_action_server_names_and_types_by_node)
    print(f"Action: {name}")
    for title, found in (("clients", clients), ("servers", servers)):
        print(f"Action {title}: {len(found)}")
        for node, types in () if arguments.count else found:
            print(f"    {node} [{', '.join(types)}]" if arguments.show_types else f"    {node}")


def _nodes_with_action(
    domain: Domain, action: str, query: Callable[..., NamesAndTypes]
) -> list[tuple[str, Sequence[str]]]:
    found = []
    for node in nodes(domain, hidden=True):
        types = dict(query(domain.node, node.name, node.namespace)).get(action)
        if types is not None:
            found.append((node.full, types))
    return found


_VERBS: Verbs = {
    "info": (
        "Show who offers and who uses an action",
        Verb(
            _info,
            ACTIONS.argument(),
            SHOW_TYPES,
            flag("-c", "--count", help="only how many clients and servers there are"),
        ),
    ),
    "list": ("List the actions", Verb(ACTIONS.list_all, SHOW_TYPES, count("actions"))),
    "send_goal": ("Send a goal, and show its result", "action.send_goal"),
    "type": ("Show an action's type", Verb(ACTIONS.list_types, ACTIONS.argument())),
}
GRAMMAR = {"action": Group(_VERBS)}
