"""`ros2 param dump`."""

from __future__ import annotations

import argparse
from typing import Any

from tutor.bundled_ros.ros2.param.client import add_node_arguments, add_timeout, parameter_client


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """NODE."""
    add_node_arguments(parser)
    add_timeout(parser)


def main(arguments: argparse.Namespace) -> None:
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
