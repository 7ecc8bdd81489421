"""Names on the graph that are almost those that the exercise asks for. Pure."""

from __future__ import annotations

import difflib
from collections.abc import Iterator
from dataclasses import dataclass

from tutor.content.live import LiveView
from tutor.ros_model import Graph

_ALIKE = 0.8
"""From this likeness on a name is taken for a slip: /temprature and /temperature have 0.96, /add and /divide 0.2."""


@dataclass(frozen=True, slots=True)
class NearMiss:
    """A node has a topic or service of a name that is close to a `wanted` one. `does` is what it does with it."""

    node: str
    does: str
    found: str
    wanted: str

    def __str__(self) -> str:
        return f"{self.node} {self.does} {self.found}; the exercise asks for {self.wanted}. Did you mean that?"


def near_misses(graph: Graph, asked: LiveView) -> Iterator[NearMiss]:
    """Every slip, by its topic or service."""
    topics, services = [topic.name for topic in asked.topics], list(asked.services)
    for topic in graph.topics:
        if topic.is_standard or topic.name in topics:
            continue
        for does, ends in (("publishes", topic.publishers), ("listens to", topic.subscriptions)):
            for node in dict.fromkeys(end.node for end in ends):
                if wanted := _near(topic.name, topics, node):
                    yield NearMiss(node, does, topic.name, wanted)
    for service in graph.services:
        if service.is_standard or service.name in services:
            continue
        for node in service.nodes:
            if wanted := _near(service.name, services, node):
                yield NearMiss(node, "serves", service.name, wanted)


def _near(name: str, wanted: list[str], node: str) -> str:
    """The name that was meant, or nothing. A node in a namespace has its names there on purpose."""
    namespace = node.rpartition("/")[0]
    if namespace and name.removeprefix(namespace) in wanted:
        return ""
    for each in wanted:
        if name.endswith(each) or each.endswith(name) or _plain(name) == _plain(each):
            return each
    return next(iter(difflib.get_close_matches(name, wanted, n=1, cutoff=_ALIKE)), "")


def _plain(name: str) -> str:
    return name.replace("/", "").replace("_", "").casefold()
