"""The graph as rows: the drawing, then in words why endpoints are not connected and what each node offers. Pure."""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Iterator, Sequence

from tutor.ros_model import Graph, Topic, connections
from tutor.tui.live.graph_drawing import draw_graph
from tutor.tui.widgets.line_view import Row

_INDENT = "  "


def rows_of_graph(graph: Graph, width: int, include_standard: bool) -> list[Row]:
    """Return the rows of the graph; topics and services that every node has only with `include_standard`."""
    topics = [topic for topic in graph.topics if include_standard or not topic.is_standard]
    rows = list(_problems(graph, width))
    rows += draw_graph(topics, width)
    if topics:
        rows.append(())
    for topic in topics:
        rows += _unconnected(topic, width)
    rows += _nodes(graph, width, include_standard)
    return rows


def _problems(graph: Graph, width: int) -> Iterator[Row]:
    broken = sum(bool(pair.problems) for topic in graph.topics for pair in connections(topic))
    duplicates = [name for name, count in Counter(graph.nodes).items() if count > 1]
    if broken:
        yield ((f"✗ {broken} connection{'s do' if broken > 1 else ' does'} not work: see below", "bad"),)
    for name in duplicates:
        text = f"! {graph.nodes.count(name)} nodes are named {name}: each name should be unique."
        yield from _wrapped(text, width, "warn", "")
    if broken or duplicates:
        yield ()


def _unconnected(topic: Topic, width: int) -> Iterator[Row]:
    for pair in connections(topic):
        if pair.problems:
            yield ((f"✗ {pair.publisher.node} ──✗ {pair.subscription.node}", "bad"), ("  not connected", "bad"))
            for problem in pair.problems:
                yield from _wrapped(problem, width, "bad", _INDENT)
            yield ()


def _nodes(graph: Graph, width: int, include_standard: bool) -> Iterator[Row]:
    if graph.nodes:
        yield (("Nodes", "title"),)
    for node in dict.fromkeys(graph.nodes):
        yield ((f"  {node}", "name"),)
        shown = [topic for topic in graph.topics if include_standard or not topic.is_standard]
        publishes = [topic.name for topic in shown if any(end.node == node for end in topic.publishers)]
        subscribes = [topic.name for topic in shown if any(end.node == node for end in topic.subscriptions)]
        serves = [
            service.name
            for service in graph.services
            if node in service.nodes and (include_standard or not service.is_standard)
        ]
        if include_standard:
            yield from _qos(shown, node)
        for word, names in (("publishes", publishes), ("listens to", subscribes), ("serves", serves)):
            if names:
                yield from _wrapped(f"{word:<11}{', '.join(names)}", width, "", "    ", hang=11)
        if not (publishes or subscribes or serves):
            yield (("    no topic or service of its own", "quiet"),)


def _qos(topics: Sequence[Topic], node: str) -> Iterator[Row]:
    """Yield the QoS of the node's publishers and subscriptions, one row per endpoint."""
    for topic in topics:
        for arrow, ends in (("──▶", topic.publishers), ("◀──", topic.subscriptions)):
            for end in ends:
                if end.node == node:
                    yield ((f"    {arrow} {topic.name}", ""), (f"  {end.qos}", "quiet"))


def _wrapped(text: str, width: int, kind: str, indent: str, hang: int = 0) -> Iterator[Row]:
    room = max(20, width - len(indent))
    for line in textwrap.wrap(text, room, subsequent_indent=" " * hang, break_on_hyphens=False):
        yield ((indent + line, kind),)
