"""I2.2: what is asked of the launch file, and the facts that are gathered."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from tutor.judge.trace import Ending, LogRecord, Sample, Trace
from tutor.ros_model import Graph, TopicEndpoint, is_standard_topic

FILE = "my_launch.py"
NAMESPACE = "robot1"
ANOTHER = "robot2"
"""The namespace that is asked for where everything is in the first one already, without arguments."""

ARGUMENTS = ("topic", "namespace")

_TELLING = 4
"""A text of this many letters does not stand in a log message by chance."""

_NUMBER = re.compile(r"[-+\d.,e]+")

Pair = tuple[TopicEndpoint, TopicEndpoint]
"""A publisher and a subscription on one topic, of two nodes."""


@dataclass(frozen=True)
class LaunchRun:
    """One launch. `command_lines` are the command lines of its processes, itself included.

    `hidden` are topics whose type this ROS does not have, so that their messages cannot be seen. `answering` are the
    nodes that answered a request after messages had come. `parted`: the nodes had met, and do so no longer; the graph
    is then that of their meeting.
    """

    trace: Trace
    arguments: Mapping[str, str] = field(default_factory=dict)
    command_lines: tuple[str, ...] = ()
    hidden: frozenset[str] = frozenset()
    answering: frozenset[str] = frozenset()
    ending: Ending | None = None
    parted: bool = False

    @property
    def typed(self) -> str:
        """The arguments as one types them."""
        return " ".join(f"{name}:={value}" for name, value in self.arguments.items()) or "no arguments"


def publishers(graph: Graph) -> list[TopicEndpoint]:
    """The publishers, but for those that ROS makes by itself."""
    return [each for each in graph.publishers if not _is_standard(each.topic)]


def subscriptions(graph: Graph) -> list[TopicEndpoint]:
    """The subscriptions, but for those that ROS makes by itself."""
    return [each for each in graph.subscriptions if not _is_standard(each.topic)]


def _is_standard(topic: str) -> bool:
    return is_standard_topic(topic) or topic == "/clock" or any(part.startswith("_") for part in topic.split("/"))


def find_pair(graph: Graph) -> Pair | None:
    """A publisher and a subscription, on whatever topics, of two nodes; on one topic, if there is such a pair."""
    apart = (
        (one, other)
        for one in publishers(graph)
        for other in subscriptions(graph)
        if _are_of_two_nodes(graph, one.node, other.node)
    )
    return next(iter(pairs(graph)), None) or next(apart, None)


def pairs(graph: Graph) -> list[Pair]:
    """All publishers and subscriptions that share a topic and are of two nodes."""
    return [
        (one, other)
        for one in publishers(graph)
        for other in subscriptions(graph)
        if one.topic == other.topic and _are_of_two_nodes(graph, one.node, other.node)
    ]


def _are_of_two_nodes(graph: Graph, one: str, other: str) -> bool:
    return one != other or graph.nodes.count(one) > 1


def topics_in_use(graph: Graph) -> set[str]:
    """The topics that something publishes on or subscribes to."""
    return {each.topic for each in (*publishers(graph), *subscriptions(graph))}


def shared_topics(graph: Graph) -> set[str]:
    """The topics on which a node publishes to which another one subscribes."""
    return {one.topic for one, _ in pairs(graph)}


def shared_namespaces(graph: Graph) -> set[str]:
    """The namespaces that both nodes of a pair are in, and their topic with them, such as "/demo"; "" is none."""
    spaces = {(one.topic, each.node.rpartition("/")[0]) for one, other in pairs(graph) for each in (one, other)}
    return {space for topic, space in spaces if topic.startswith(f"{space}/")}


def pairs_on_topic(graph: Graph, name: str, within: Iterable[str] = ()) -> list[Pair]:
    """The pairs on /name, or on this name in one of the namespaces."""
    wanted = {f"{space}/{name}" for space in ("", *within)}
    return [pair for pair in pairs(graph) if pair[0].topic in wanted]


def pairs_on_topic_named(graph: Graph, name: str) -> list[Pair]:
    """The pairs on a topic of this name, in whatever namespace."""
    return [pair for pair in pairs(graph) if pair[0].topic.endswith(f"/{name}")]


def pairs_in_namespace(graph: Graph, name: str | None = None, *, space: str = NAMESPACE) -> list[Pair]:
    """The pairs of which both nodes and the topic (called `name`, if given) are under the namespace."""
    return [
        (one, other)
        for one, other in pairs(graph)
        if all(_is_under(each, space) for each in (one.topic, one.node, other.node))
        and (name is None or one.topic.endswith(f"/{name}"))
    ]


def has_pair_in_namespace(graph: Graph) -> bool:
    """Whether a publisher and a subscription of two nodes are under the namespace, on whatever topics there."""
    return any(
        _are_of_two_nodes(graph, one.node, other.node)
        for one in publishers(graph)
        for other in subscriptions(graph)
        if all(_is_under(name, NAMESPACE) for each in (one, other) for name in (each.node, each.topic))
    )


def _is_under(name: str, space: str) -> bool:
    return name.startswith(f"/{space}/") and not is_namespace_doubled(name, space)


def is_namespace_doubled(name: str, space: str) -> bool:
    """Whether the namespace was put before this name twice, as in /robot1/robot1/talker."""
    return name.startswith(f"/{space}/{space}/")


def count_entities(graph: Graph) -> tuple[int, int, int]:
    """How many nodes, publishers and subscriptions there are."""
    return len(graph.nodes), len(publishers(graph)), len(subscriptions(graph))


def logs_of_messages(pair: Pair, logs: Sequence[LogRecord], samples: Sequence[Sample]) -> list[LogRecord]:
    """What the subscriber logged that has the content of a message in it.

    A number or a few letters may stand in any log message: they count where they follow two messages that differ.
    """
    name = pair[1].node.strip("/").replace("/", ".")
    own = [log for log in logs if log.name == name or log.name.startswith(f"{name}.")]
    said = {
        log: {text for sample in samples if sample.source_time <= log.stamp + 0.01 for text in _said(log.text, sample)}
        for log in own
    }
    texts = set().union(*said.values())
    telling = any(len(text) >= _TELLING and not _NUMBER.fullmatch(text) for text in texts)
    return [log for log in own if said[log]] if telling or len(texts) > 1 else []


def _said(text: str, sample: Sample) -> Iterator[str]:
    """The contents of a message that stand in a text as words of their own."""
    for value in {str(leaf).strip() for leaf in _leaves(sample.message)} - {""}:
        if re.search(rf"(?<![\w.]){re.escape(value)}(?!\w|\.\d)", text, re.IGNORECASE):
            yield value


def _leaves(value: Any) -> Iterator[Any]:
    if isinstance(value, Mapping):
        for each in value.values():
            yield from _leaves(each)
    elif isinstance(value, (list, tuple)):
        for each in value[:100]:
            yield from _leaves(each)
    else:
        yield value
