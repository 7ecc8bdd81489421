"""`ros2 param list`, `get`, `describe` and `dump`."""

from __future__ import annotations

import argparse
import re
import sys
from typing import Any

from tutor.bundled_ros.ros2.arguments import STRATEGY
from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.bundled_ros.ros2.names import complete_nodes, nodes
from tutor.bundled_ros.ros2.param.client import NODE, TIMEOUT, ParameterClient, complete_parameters, parameter_client
from tutor.bundled_ros.ros2.parsing import Verb, argument, flag
from tutor.errors import CommandError
from tutor.ros_model import PARAMETER_TYPES, NodeName


def _list(arguments: argparse.Namespace) -> None:
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
            _print_parameters(domain, node.full, pattern, arguments)


def _compile_pattern(given: list[str] | None) -> re.Pattern[str]:
    try:
        return re.compile(given[0] if given else "")
    except re.error as error:
        raise CommandError(f"'{given[0] if given else ''}' is not a regular expression: {error}") from error


def _print_parameters(domain: Domain, node: str, pattern: re.Pattern[str], arguments: argparse.Namespace) -> None:
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


def _get(arguments: argparse.Namespace) -> None:
    """Print the value. Raises CommandError if there is no such node or parameter."""
    from rclpy.parameter import parameter_value_to_python

    with parameter_client(arguments) as node:
        values = node.values([arguments.parameter_name])
    if not values:
        raise CommandError("Parameter not set")
    value, kind = parameter_value_to_python(values[0]), PARAMETER_TYPES[values[0].type]
    if arguments.hide_type:
        print(value)
    elif value is None:
        print("Parameter not set.")
    else:
        print(f"{kind.removesuffix(' array').capitalize()} {'values are' if 'array' in kind else 'value is'}: {value}")


def _describe(arguments: argparse.Namespace) -> None:
    """Print the parameters' descriptors; undeclared parameters are skipped."""
    with parameter_client(arguments) as node:
        for descriptor in node.descriptors(arguments.parameter_names):
            _print_descriptor(descriptor)


def _print_descriptor(descriptor: Any) -> None:
    print(f"Parameter name: {descriptor.name}")
    print(f"  Type: {PARAMETER_TYPES[descriptor.type]}")
    if descriptor.description:
        print(f"  Description: {descriptor.description}")
    print("  Constraints:")
    if descriptor.read_only:
        print("    Read only: true")
    for allowed in [*descriptor.floating_point_range, *descriptor.integer_range][:1]:
        print(f"    Min value: {allowed.from_value}")
        print(f"    Max value: {allowed.to_value}")
        if allowed.step:
            print(f"    Step: {allowed.step}")
    if descriptor.additional_constraints:
        print(f"    Additional constraints: {descriptor.additional_constraints}")


def _dump(arguments: argparse.Namespace) -> None:
    """Print the node's parameters as a parameter file."""
    import yaml
    from rclpy.parameter import parameter_value_to_python

    with parameter_client(arguments) as node:
        names = node.names()
        values = [parameter_value_to_python(value) for value in node.values(names)]
    tree: dict[str, Any] = {}
    for name, value in zip(names, values, strict=False):
        _insert(tree, name.split("."), value)
    print(yaml.dump({node.node_name: {"ros__parameters": tree}}, default_flow_style=False))


def _insert(tree: dict[str, Any], path: list[str], value: Any) -> None:
    """Insert the value of `a.b.c` as `tree[a][b][c]`."""
    for part in path[:-1]:
        tree = tree.setdefault(part, {})
    tree[path[-1]] = value


GRAMMAR = {
    "describe": Verb(
        _describe,
        *NODE,
        argument("parameter_names", nargs="+", complete=complete_parameters, help="the parameters"),
        TIMEOUT,
    ),
    "dump": Verb(_dump, *NODE, TIMEOUT),
    "get": Verb(
        _get,
        *NODE,
        argument("parameter_name", complete=complete_parameters, help="the parameter"),
        flag("--hide-type", help="the value only"),
        TIMEOUT,
    ),
    "list": Verb(
        _list,
        *STRATEGY,
        argument("node_name", nargs="?", complete=complete_nodes, help="only of this node"),
        argument("--filter", nargs=1, help="only parameters that match this regular expression"),
        flag("--include-hidden-nodes", help="hidden nodes as well"),
        argument("--param-prefixes", nargs="+", default=[], help="only parameters below these prefixes"),
        flag("--param-type", help="the types as well"),
    ),
}
