"""A client of a node's parameter services, and what the `ros2 param` verbs share."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from tutor.bundled_ros.ros2.arguments import STRATEGY
from tutor.bundled_ros.ros2.calling import wait_for_answer, wait_until
from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.bundled_ros.ros2.names import complete_nodes, nodes
from tutor.bundled_ros.ros2.parsing import argument, flag
from tutor.errors import CommandError
from tutor.ros_model import NodeName

SERVICES_TIMEOUT_S = 5.0


NODE = (
    *STRATEGY,
    argument("node_name", complete=complete_nodes, help="the node, such as /talker"),
    flag("--include-hidden-nodes", help="hidden nodes as well"),
)
"""The first arguments of verbs on a single node."""

TIMEOUT = argument(
    "--timeout",
    metavar="N",
    type=int,
    help="wait up to N seconds for a node that is not there yet (default: not at all, since all nodes are known)",
)


class ParameterClient:
    """The parameter services of one node. Each method raises CommandError if a call fails."""

    def __init__(self, domain: Domain, node_name: str) -> None:
        from rclpy.parameter_client import AsyncParameterClient

        self._domain, self.node_name = domain, node_name
        self._client = AsyncParameterClient(domain.node, node_name)
        if not wait_until(self._client.services_are_ready, limit_s=SERVICES_TIMEOUT_S):
            raise CommandError(f"Wait for service timed out waiting for parameter services for node {node_name}")

    def names(self, prefixes: Sequence[str] = ()) -> list[str]:
        """Return the node's sorted parameter names, optionally only those below some prefixes."""
        answer = self._await_answer(self._client.list_parameters(list(prefixes) or None))
        return sorted(answer.result.names)

    def values(self, names: Sequence[str]) -> list[Any]:
        """Return the values (rcl_interfaces/msg/ParameterValue); an empty list if a parameter is not declared."""
        return list(self._await_answer(self._client.get_parameters(list(names))).values)

    def descriptors(self, names: Sequence[str]) -> list[Any]:
        """Return the descriptors (rcl_interfaces/msg/ParameterDescriptor)."""
        return list(self._await_answer(self._client.describe_parameters(list(names))).descriptors)

    def set(self, parameters: Sequence[Any]) -> list[Any]:
        """Set the parameters one by one and return a SetParametersResult for each."""
        return list(self._await_answer(self._client.set_parameters(list(parameters))).results)

    def _await_answer(self, future: Any) -> Any:
        return wait_for_answer(self._domain, future, notice=lambda: f"{self.node_name} has not answered yet")


@contextmanager
def parameter_client(arguments: argparse.Namespace) -> Iterator[ParameterClient]:
    """Join the domain and find the named node. Raises CommandError if it does not exist."""
    name = NodeName.parse(arguments.node_name).full
    with join_domain(arguments) as domain:
        find_node(domain, name, hidden=arguments.include_hidden_nodes, limit_s=arguments.timeout)
        yield ParameterClient(domain, name)


def find_node(domain: Domain, name: str, *, hidden: bool, limit_s: float | None) -> None:
    """Wait for a node, by its full name. Raises CommandError if it does not appear within `limit_s` seconds."""

    def exists() -> bool:
        return any(node.full == name for node in nodes(domain, hidden=hidden))

    if domain.find(lambda: exists() or None) is None and not wait_until(exists, limit_s=limit_s or 0.0):
        raise CommandError("Node not found")


def complete_parameters(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Complete the parameters of the node that was typed."""
    with join_domain(parsed_args) as domain:
        name = NodeName.parse(parsed_args.node_name).full
        find_node(domain, name, hidden=True, limit_s=None)
        return ParameterClient(domain, name).names()
