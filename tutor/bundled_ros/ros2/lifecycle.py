"""`ros2 lifecycle`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from tutor.bundled_ros.ros2.arguments import STRATEGY, count
from tutor.bundled_ros.ros2.calling import wait_for_answer, wait_until
from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.bundled_ros.ros2.names import SERVICES, nodes
from tutor.bundled_ros.ros2.parsing import Group, Verb, Verbs, argument, flag
from tutor.errors import CommandError
from tutor.ros_model import NodeName

_TYPES = {
    "change_state": "ChangeState",
    "get_available_transitions": "GetAvailableTransitions",
    "get_state": "GetState",
    "get_transition_graph": "GetAvailableTransitions",
}
"""The services of a lifecycle node that we call, and their types in lifecycle_msgs."""


def _nodes(arguments: argparse.Namespace) -> None:
    """Print the lifecycle nodes."""
    with join_domain(arguments) as domain:
        domain.wait_for_discovery()
        found = _lifecycle_nodes(domain, hidden=arguments.all)
    if arguments.count:
        print(len(found))
        return
    for name in sorted(set(found)):
        print(name)


def _get(arguments: argparse.Namespace) -> None:
    """Print the state of one node, or of all. Raises CommandError if no lifecycle node has the name that was given."""
    if arguments.node_name:
        with _lifecycle_node(arguments) as (domain, name):
            print(_state(domain, name))
        return
    with join_domain(arguments) as domain:
        domain.wait_for_discovery()
        for name in sorted(set(_lifecycle_nodes(domain, hidden=arguments.include_hidden_nodes))):
            print(f"{name}: {_state(domain, name)}")


def _list(arguments: argparse.Namespace) -> None:
    """Print the transitions that the node can make now, or all that there are."""
    service = "get_transition_graph" if arguments.all else "get_available_transitions"
    with _lifecycle_node(arguments) as (domain, name):
        found = _call(domain, name, service).available_transitions
    for described in found:
        print(f"- {_shown(described.transition)}")
        print(f"\tStart: {described.start_state.label}\n\tGoal: {described.goal_state.label}")


def _set(arguments: argparse.Namespace) -> None:
    """Make a transition, given by its label or id. If the node fails in it, the exit code is still 0."""
    with _lifecycle_node(arguments) as (domain, name):
        found = _call(domain, name, "get_available_transitions").available_transitions
        available = [described.transition for described in found]
        chosen = [
            *(transition for transition in available if transition.label == arguments.transition),
            *(transition for transition in available if str(transition.id) == arguments.transition),
        ]
        if not chosen:
            lines = "".join(f"\n- {_shown(transition)}" for transition in available)
            raise CommandError(f"Unknown transition requested, available ones are:{lines}")
        succeeded = _call(domain, name, "change_state", transition=chosen[0]).success
    if succeeded:
        print("Transitioning successful")
    else:
        print("Transitioning failed", file=sys.stderr)


def _lifecycle_nodes(domain: Domain, *, hidden: bool) -> list[str]:
    """Return the full names of the discovered lifecycle nodes: those that offer the service `get_state`."""
    wanted = f"lifecycle_msgs/srv/{_TYPES['get_state']}"
    services = {name for name, types in SERVICES.known(domain, hidden=hidden) if wanted in types}
    return [node.full for node in nodes(domain, hidden=hidden) if f"{node.full}/get_state" in services]


@contextmanager
def _lifecycle_node(arguments: argparse.Namespace) -> Iterator[tuple[Domain, str]]:
    """Join the domain and find the node that was named. Raises CommandError if no lifecycle node has this name."""
    name, hidden = NodeName.parse(arguments.node_name).full, arguments.include_hidden_nodes
    with join_domain(arguments) as domain:
        if not domain.find(lambda: name in _lifecycle_nodes(domain, hidden=hidden) or None):
            raise CommandError("Node not found")
        yield domain, name


def _call(domain: Domain, node: str, service: str, **request: object) -> Any:
    """Call a lifecycle service of a node, and return its response."""
    import lifecycle_msgs.srv

    service_class = getattr(lifecycle_msgs.srv, _TYPES[service])
    client = domain.node.create_client(service_class, f"{node}/{service}")
    try:
        wait_until(client.service_is_ready, notice=lambda: f"{node} does not offer {node}/{service} yet")
        future = client.call_async(service_class.Request(**request))
        return wait_for_answer(domain, future, notice=lambda: f"{node} has not answered yet")
    finally:
        domain.node.destroy_client(client)


def _state(domain: Domain, node: str) -> str:
    return _shown(_call(domain, node, "get_state").current_state)


def _shown(state_or_transition: Any) -> str:
    return f"{state_or_transition.label} [{state_or_transition.id}]"


def _complete_nodes(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    with join_domain(parsed_args) as domain:
        domain.wait_for_discovery()
        return _lifecycle_nodes(domain, hidden=getattr(parsed_args, "include_hidden_nodes", False))


def _complete_transitions(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Complete the transitions that the node that was typed can make now."""
    with _lifecycle_node(parsed_args) as (domain, name):
        found = _call(domain, name, "get_available_transitions").available_transitions
    return [described.transition.label for described in found]


_NODE = argument("node_name", complete=_complete_nodes, help="the node, such as /talker")
_HIDDEN = flag("--include-hidden-nodes", help="hidden nodes as well")

_VERBS: Verbs = {
    "get": (
        "Show the state of a lifecycle node, or of all",
        Verb(
            _get,
            *STRATEGY,
            argument("node_name", nargs="?", complete=_complete_nodes, help="only of this node"),
            _HIDDEN,
        ),
    ),
    "list": (
        "List the transitions that a lifecycle node can make now",
        Verb(_list, *STRATEGY, _NODE, _HIDDEN, flag("-a", "--all", help="all transitions that there are")),
    ),
    "nodes": (
        "List the lifecycle nodes",
        Verb(_nodes, *STRATEGY, flag("-a", "--all", help="hidden nodes as well"), count("nodes")),
    ),
    "set": (
        "Let a lifecycle node make a transition",
        Verb(
            _set,
            *STRATEGY,
            _NODE,
            _HIDDEN,
            argument("transition", complete=_complete_transitions, help="the transition, such as configure, or its id"),
        ),
    ),
}
GRAMMAR = {"lifecycle": Group(_VERBS)}
