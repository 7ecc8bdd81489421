"""A node's parameters, asked for over its parameter services."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from tutor.bundled_ros.ros2.calling import wait_for_answer, wait_until
from tutor.bundled_ros.ros2.domain import Domain, add_strategy_arguments, join_domain
from tutor.bundled_ros.ros2.node.names import node_names, nodes
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.errors import CommandError
from tutor.ros_model import NodeName

SERVICES_LIMIT_S = 5.0


def add_node_arguments(parser: argparse.ArgumentParser) -> None:
    """NODE, and what each verb that asks one node has besides."""
    add_strategy_arguments(parser)
    complete_with(parser.add_argument("node_name", help="the node, such as /talker"), node_names)
    parser.add_argument("--include-hidden-nodes", action="store_true", help="hidden nodes as well")


def add_timeout(parser: argparse.ArgumentParser) -> None:
    """How long a node that is not there is waited for."""
    parser.add_argument(
        "--timeout",
        metavar="N",
        type=int,
        help="wait up to N seconds for a node that is not there yet (default: not at all, since all nodes are known)",
    )


class ParameterClient:
    """The parameter services of one node. Each method raises CommandError where the node does not answer."""

    def __init__(self, domain: Domain, node_name: str) -> None:
        from rclpy.parameter_client import AsyncParameterClient

        self._domain, self.node_name = domain, node_name
        self._client = AsyncParameterClient(domain.node, node_name)
        if not wait_until(self._client.services_are_ready, limit_s=SERVICES_LIMIT_S):
            raise CommandError(f"Wait for service timed out waiting for parameter services for node {node_name}")

    def names(self, prefixes: Sequence[str] = ()) -> list[str]:
        """The names of its parameters, sorted."""
        answer = self._answer(self._client.list_parameters(list(prefixes) or None))
        return sorted(answer.result.names)

    def values(self, names: Sequence[str]) -> list[Any]:
        """Their values (rcl_interfaces/msg/ParameterValue); empty where one is not declared."""
        return list(self._answer(self._client.get_parameters(list(names))).values)

    def descriptors(self, names: Sequence[str]) -> list[Any]:
        """What it says about them (rcl_interfaces/msg/ParameterDescriptor)."""
        return list(self._answer(self._client.describe_parameters(list(names))).descriptors)

    def set(self, parameters: Sequence[Any]) -> list[Any]:
        """Set them, each by itself; gives a SetParametersResult for each."""
        return list(self._answer(self._client.set_parameters(list(parameters))).results)

    def _answer(self, future: Any) -> Any:
        return wait_for_answer(self._domain, future, remark=lambda: f"{self.node_name} has not answered yet")


@contextmanager
def parameter_client(arguments: argparse.Namespace) -> Iterator[ParameterClient]:
    """Join the domain, and find the node that was named. Raises CommandError where it is not there."""
    name = NodeName.parse(arguments.node_name).full
    with join_domain(arguments) as domain:
        find_node(domain, name, hidden=arguments.include_hidden_nodes, limit_s=arguments.timeout)
        yield ParameterClient(domain, name)


def find_node(domain: Domain, name: str, *, hidden: bool, limit_s: float | None) -> None:
    """Find a node by its full name. Raises CommandError where it is not there, nor comes within `limit_s` seconds."""

    def is_there() -> bool:
        return any(node.full == name for node in nodes(domain, hidden=hidden))

    if domain.find(lambda: is_there() or None) is None and not wait_until(is_there, limit_s=limit_s or 0.0):
        raise CommandError("Node not found")


def parameter_names(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """The parameters that Tab offers, of the node that was named."""
    with join_domain(parsed_args) as domain:
        name = NodeName.parse(parsed_args.node_name).full
        find_node(domain, name, hidden=True, limit_s=None)
        return ParameterClient(domain, name).names()


def print_results(results: Sequence[tuple[str, Any]]) -> None:
    """Print what became of each change: what was done to stdout, what was refused to stderr.

    Each result has its words: `"Set parameter {}"` gives `Set parameter successful` or `Setting parameter failed`.
    """
    for words, result in results:
        done, _, refused = words.partition("|")
        reason = f": {result.reason}" if result.reason else ""
        print((done if result.successful else refused) + reason, file=sys.stdout if result.successful else sys.stderr)


def plain_value(value: Any) -> Any:
    """A ParameterValue as a Python value; None where it is not set."""
    from rclpy.parameter import parameter_value_to_python

    found = parameter_value_to_python(value)
    to_list: Callable[[], Any] | None = getattr(found, "tolist", None)
    return to_list() if to_list is not None else found
