"""Node names and their tab completion."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.ros_model import NodeName


def nodes(domain: Domain, *, hidden: bool) -> list[NodeName]:
    """Return all discovered nodes, duplicate names included; with `hidden`, also those whose name starts with `_`."""
    found = [NodeName(name, namespace) for name, namespace in domain.node.get_node_names_and_namespaces()]
    return [node for node in found if hidden or (node.name and not node.name.startswith("_"))]


def node_names(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Complete node names."""
    with join_domain(parsed_args) as domain:
        domain.wait_for_discovery()
        return [node.full for node in nodes(domain, hidden=getattr(parsed_args, "include_hidden_nodes", False))]
