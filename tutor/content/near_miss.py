"""Finds topic and service names on the graph that almost match those of the exercise. Pure functions."""

from __future__ import annotations

import difflib
from collections.abc import Iterator
from dataclasses import dataclass

from tutor.content.live import LiveView
from tutor.ros_model import Graph

_MIN_SIMILARITY = 0.8
"""difflib ratio from which a name counts as a misspelling: /temprature, /temperature: 0.96; /add, /divide: 0.2."""


@dataclass(frozen=True, slots=True)
class NearMiss:
    """A node uses a topic or service, `found`, whose name is close to a `wanted` one. `does` is a verb: "publishes"."""

    node: str
    does: str
    found: str
    wanted: str

    def __str__(self) -> str:
        return f"{self.node} {self.does} {self.found}; the exercise asks for {self.wanted}. Did you mean that?"


def near_misses(graph: Graph, asked: LiveView) -> Iterator[NearMiss]:
    """Yield every near miss: first by topic, then by service; none where such a name may be the fault to be found.

    A node that also uses the wanted name has misspelled nothing.
    """
    if asked.has_hidden_fault:
        return
    topics, services = [topic.name for topic in asked.topics], list(asked.services)
    ends = [
        ("publishes", {topic.name: {end.node for end in topic.publishers} for topic in graph.topics}),
        ("listens to", {topic.name: {end.node for end in topic.subscriptions} for topic in graph.topics}),
    ]
    for topic in graph.topics:
        if topic.is_standard or topic.name in topics:
            continue
        for does, nodes in ends:
            for node in sorted(nodes[topic.name]):
                if (wanted := _closest(topic.name, topics, node)) and node not in nodes.get(wanted, ()):
                    yield NearMiss(node, does, topic.name, wanted)
    serving = {service.name: set(service.nodes) for service in graph.services}
    for service in graph.services:
        if service.is_standard or service.name in services:
            continue
        for node in service.nodes:
            if (wanted := _closest(service.name, services, node)) and node not in serving.get(wanted, ()):
                yield NearMiss(node, "serves", service.name, wanted)


def _closest(name: str, wanted: list[str], node: str) -> str:
    """Return the wanted name that was probably meant, or "".

    A wanted name within the node's own namespace is no slip: the node was put there on purpose.
    """
    namespace = node.rpartition("/")[0]
    if namespace and name.removeprefix(namespace) in wanted:
        return ""
    for candidate in wanted:
        if name.endswith(candidate) or candidate.endswith(name) or _normalize(name) == _normalize(candidate):
            return candidate
    return next(iter(difflib.get_close_matches(name, wanted, n=1, cutoff=_MIN_SIMILARITY)), "")


def _normalize(name: str) -> str:
    return name.replace("/", "").replace("_", "").casefold()
