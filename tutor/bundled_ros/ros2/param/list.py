"""`ros2 param list`."""

from __future__ import annotations

import argparse
import re
import sys

from tutor.bundled_ros.ros2.domain import Domain, add_strategy_arguments, join_domain
from tutor.bundled_ros.ros2.node.names import node_names, nodes
from tutor.bundled_ros.ros2.param.client import ParameterClient
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.errors import CommandError
from tutor.ros_model import PARAMETER_TYPES, NodeName


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[--filter REGEX] [--param-prefixes PREFIX ...] [--param-type] [NODE]."""
    add_strategy_arguments(parser)
    complete_with(parser.add_argument("node_name", nargs="?", help="only of this node"), node_names)
    parser.add_argument("--filter", nargs=1, help="only parameters that match this regular expression")
    parser.add_argument("--include-hidden-nodes", action="store_true", help="hidden nodes as well")
    parser.add_argument("--param-prefixes", nargs="+", default=[], help="only parameters below these prefixes")
    parser.add_argument("--param-type", action="store_true", help="the types as well")


def main(arguments: argparse.Namespace) -> None:
    """Print the parameters of one node or of all. Raises CommandError if the named node does not exist."""
    pattern = _compile_pattern(arguments.filter)
    with join_domain(arguments) as domain:
        domain.wait_for_discovery()
        found = sorted(nodes(domain, hidden=arguments.include_hidden_nodes))
        if arguments.node_name:
            wanted = NodeName.parse(arguments.node_name).full
            found = [node for node in found if node.full == wanted][:1]
            if not found:
                raise CommandError("Node not found")
        for node in found:
            _print_node(domain, node.full, pattern, arguments)


def _compile_pattern(given: list[str] | None) -> re.Pattern[str]:
    try:
        return re.compile(given[0] if given else "")
    except re.error as error:
        raise CommandError(f"'{given[0] if given else ''}' is not a regular expression: {error}") from error


def _print_node(domain: Domain, node: str, pattern: re.Pattern[str], arguments: argparse.Namespace) -> None:
    try:
        client = ParameterClient(domain, node)
        names = [name for name in client.names(arguments.param_prefixes) if pattern.match(name)]
        types = (
            {info.name: PARAMETER_TYPES[info.type] for info in client.descriptors(names)}
            if arguments.param_type
            else {}
        )
    except CommandError as error:
        if arguments.node_name:
            raise
        print(error, file=sys.stderr)  # still show the other nodes' parameters
        return
    if not arguments.node_name and names:
        print(f"{node}:")
    for name in names:
        print(f"  {name} (type: {types[name]})" if arguments.param_type else f"  {name}")
