"""The graph as lines of text: every topic with who is connected, and what keeps some from being so. Pure."""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Iterator

from tutor.live.facts import Endpoint, Graph, Topic
from tutor.live.mismatch import connections
from tutor.tui.live.state import is_plumbing, is_plumbing_service
from tutor.tui.live.words import short_type
from tutor.tui.widgets.line_view import Row

_INDENT = "      "


def graph_rows(graph: Graph, width: int, everything: bool) -> list[Row]:
    """The whole graph; without `everything` the topics and services that every node has are left out."""
    topics = [topic for topic in graph.topics if everything or not is_plumbing(topic.name)]
    rows = list(_problems(graph, width))
    if topics:
        rows.append((("Topics", "title"),))
    for topic in topics:
        rows += _topic(topic, width)
        rows.append(())
    rows += _nodes(graph, width, everything)
    return rows


def _problems(graph: Graph, width: int) -> Iterator[Row]:
    broken = sum(bool(pair.problems) for topic in graph.topics for pair in connections(topic))
    twice = [name for name, times in Counter(graph.nodes).items() if times > 1]
    if broken:
        yield ((f"✗ {broken} connection{'s do' if broken > 1 else ' does'} not work: see below", "bad"),)
    for name in twice:
        text = f"! {graph.nodes.count(name)} nodes are named {name}: each name should be there once."
        yield from _wrapped(text, width, "warn", "")
    if broken or twice:
        yield ()


def _topic(topic: Topic, width: int) -> Iterator[Row]:
    yield ((f"  {topic.name}", "name"), (f"  {' ✗ '.join(map(short_type, topic.types))}", "quiet"))
    if not topic.subscriptions:
        for publisher in topic.publishers:
            yield ((f"    {publisher.node} ──▶ ", ""), ("nobody listens", "quiet"), *_qos(publisher))
    if not topic.publishers:
        for subscription in topic.subscriptions:
            yield (("    ", ""), ("nobody publishes", "warn"), (f" ──▶ {subscription.node}", ""), *_qos(subscription))
    for pair in connections(topic):
        if not pair.problems:
            yield ((f"    {pair.publisher.node} ──▶ {pair.subscription.node}", ""), *_qos(pair.publisher))
            continue
        text = f"    {pair.publisher.node} ──✗ {pair.subscription.node}"
        yield ((text, "bad"), ("  not connected", "bad"))
        for problem in pair.problems:
            yield from _wrapped(problem, width, "bad", _INDENT)


def _nodes(graph: Graph, width: int, everything: bool) -> Iterator[Row]:
    if graph.nodes:
        yield (("Nodes", "title"),)
    for node in dict.fromkeys(graph.nodes):
        yield ((f"  {node}", "name"),)
        shown = [topic for topic in graph.topics if everything or not is_plumbing(topic.name)]
        publishes = [topic.name for topic in shown if any(end.node == node for end in topic.publishers)]
        listens = [topic.name for topic in shown if any(end.node == node for end in topic.subscriptions)]
        serves = [
            service.name
            for service in graph.services
            if node in service.nodes and (everything or not is_plumbing_service(service.name))
        ]
        for word, names in (("publishes", publishes), ("listens to", listens), ("serves", serves)):
            if names:
                yield from _wrapped(f"{word:<11}{', '.join(names)}", width, "", "    ", hang=11)
        if not (publishes or listens or serves):
            yield (("    no topic or service of its own", "quiet"),)


def _qos(end: Endpoint) -> Row:
    return ((f"  {end.qos}", "quiet"),)


def _wrapped(text: str, width: int, kind: str, indent: str, hang: int = 0) -> Iterator[Row]:
    room = max(20, width - len(indent))
    for line in textwrap.wrap(text, room, subsequent_indent=" " * hang, break_on_hyphens=False):
        yield ((indent + line, kind),)
