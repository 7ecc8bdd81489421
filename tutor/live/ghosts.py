"""Nodes that have left and that rmw goes on listing."""

from __future__ import annotations

from dataclasses import replace

from tutor.ros_model import Graph


def without_ghosts(graph: Graph, connected: set[str]) -> Graph:
    """The graph without nodes that have left. `connected` collects the nodes that have had endpoints, over all calls.

    On a busy machine, rmw has gone on listing a node whose process had ended. All of that node's endpoints were gone,
    and a running node never loses all of its own.
    """
    now = {end.node for ends in (graph.publishers, graph.subscriptions) for end in ends}
    now |= {end.node for ends in (graph.servers, graph.clients) for end in ends}
    connected |= now
    gone = connected - now
    return replace(graph, nodes=tuple(node for node in graph.nodes if node not in gone))
