"""Nodes by name, and what Tab offers for them."""

from __future__ import annotations

import argparse
from typing import NamedTuple

from tutor.bundled_ros.ros2.domain import Domain, join_domain


class NodeName(NamedTuple):
    """A node's name and namespace, such as `talker` in `/robot1`."""

    name: str
    namespace: str

    @property
    def full(self) -> str:
        """Both, as in `/robot1/talker`."""
        return f"{self.namespace.rstrip('/')}/{self.name}"


def nodes(domain: Domain, *, hidden: bool) -> list[NodeName]:
    """All nodes that are seen, two of one name twice; `hidden`: also those whose name starts with `_`."""
    found = [NodeName(name, namespace) for name, namespace in domain.node.get_node_names_and_namespaces()]
    return [node for node in found if hidden or (node.name and not node.name.startswith("_"))]


def absolute(name: str) -> str:
    """A node's name with the slash in front that may be left out."""
    return name if name.startswith("/") else f"/{name}"


def split(name: str) -> NodeName:
    """The parts of a full name."""
    namespace, _, last = absolute(name).rpartition("/")
    return NodeName(last, namespace or "/")


def node_names(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """The nodes that Tab offers."""
    with join_domain(parsed_args) as domain:
        domain.complete()
        return [node.full for node in nodes(domain, hidden=getattr(parsed_args, "include_hidden_nodes", False))]
