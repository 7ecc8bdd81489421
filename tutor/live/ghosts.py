"""Hides nodes that have left, but are still listed by the RMW layer."""

from __future__ import annotations

from dataclasses import replace

from tutor.ros_model import Graph


def without_ghosts(graph: Graph, connected: set[str]) -> Graph:
    """Return the graph without nodes that have left.

    `connected` collects, across calls, all nodes that have ever had endpoints. On a busy machine, rmw was seen to keep
    listing a node after its process had ended, but without any endpoints. A running node never loses all its endpoints.
    """
    now = {endpoint.node for group in (graph.publishers, graph.subscriptions) for endpoint in group}
    now |= {endpoint.node for group in (graph.servers, graph.clients) for endpoint in group}
    connected |= now
    gone = connected - now
    return replace(graph, nodes=tuple(node for node in graph.nodes if node not in gone))
