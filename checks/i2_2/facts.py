"""I2.2: what the launch file must do, and the facts gathered about it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from tutor.judge.trace import Ending, LogRecord, Sample, Trace
from tutor.ros_model import Graph, TopicEndpoint, is_standard_topic

FILE = "my_launch.py"
NAMESPACE = "robot1"
SECOND_NAMESPACE = "robot2"
"""Used instead of `NAMESPACE` where the launch file puts everything into that one by default."""

ARGUMENTS = ("topic", "namespace")

_TELLING_LENGTH = 4
"""Text of at least this many characters is unlikely to appear in a log message by chance."""

_NUMBER = re.compile(r"[-+\d.,e]+")

Pair = tuple[TopicEndpoint, TopicEndpoint]
"""A publisher and a subscription of two different nodes, usually on the same topic."""


@dataclass(frozen=True)
class LaunchRun:
    """One launch. `command_lines`: those of all its processes, including `ros2 launch` itself.

    `hidden`: topics whose message type is not installed, so that their messages cannot be read. `answering`: the nodes
    that still answered a service request after messages had arrived. `disconnected`: a publisher and a subscription had
    matched, but one of them has gone since; `trace.graph` is then the graph from when they were matched.
    """

    trace: Trace
    arguments: Mapping[str, str] = field(default_factory=dict)
    command_lines: tuple[str, ...] = ()
    hidden: frozenset[str] = frozenset()
    answering: frozenset[str] = frozenset()
    ending: Ending | None = None
    disconnected: bool = False

    @property
    def typed(self) -> str:
        """The launch arguments as typed on the command line."""
        return " ".join(f"{name}:={value}" for name, value in self.arguments.items()) or "no arguments"


def publishers(graph: Graph) -> list[TopicEndpoint]:
    """The publishers, except those that ROS creates itself."""
    return [each for each in graph.publishers if not _is_standard(each.topic)]


def subscriptions(graph: Graph) -> list[TopicEndpoint]:
    """The subscriptions, except those that ROS creates itself."""
    return [each for each in graph.subscriptions if not _is_standard(each.topic)]


def _is_standard(topic: str) -> bool:
    return is_standard_topic(topic) or topic == "/clock" or bool({"_action", "_service_event"} & {*topic.split("/")})


def find_pair(graph: Graph) -> Pair | None:
    """A publisher and a subscription of two nodes: on the same topic if there is such a pair, else on any topics."""
    apart = (
        (one, other)
        for one in publishers(graph)
        for other in subscriptions(graph)
        if _are_different_nodes(graph, one.node, other.node)
    )
    return next(iter(pairs(graph)), None) or next(apart, None)


def pairs(graph: Graph) -> list[Pair]:
    """All pairs of a publisher and a subscription that share a topic and belong to different nodes."""
    return [
        (one, other)
        for one in publishers(graph)
        for other in subscriptions(graph)
        if one.topic == other.topic and _are_different_nodes(graph, one.node, other.node)
    ]


def _are_different_nodes(graph: Graph, one: str, other: str) -> bool:
    return one != other or graph.nodes.count(one) > 1


def topics_in_use(graph: Graph) -> set[str]:
    """The topics with a publisher or a subscription."""
    return {each.topic for each in (*publishers(graph), *subscriptions(graph))}


def shared_topics(graph: Graph) -> set[str]:
    """The topics that connect one node's publisher to another node's subscription."""
    return {one.topic for one, _ in pairs(graph)}


def shared_namespaces(graph: Graph) -> set[str]:
    """The namespaces that contain both nodes of a pair and their topic, such as "/demo"; "" is the root."""
    spaces = {(one.topic, each.node.rpartition("/")[0]) for one, other in pairs(graph) for each in (one, other)}
    return {space for topic, space in spaces if topic.startswith(f"{space}/")}


def pairs_on_topic(graph: Graph, name: str, within: Iterable[str] = ()) -> list[Pair]:
    """The pairs on /name, or on /namespace/name for one of the namespaces in `within`."""
    wanted = {f"{space}/{name}" for space in ("", *within)}
    return [pair for pair in pairs(graph) if pair[0].topic in wanted]


def pairs_on_topic_named(graph: Graph, name: str) -> list[Pair]:
    """The pairs on a topic with this name, in any namespace."""
    return [pair for pair in pairs(graph) if pair[0].topic.endswith(f"/{name}")]


def pairs_in_namespace(graph: Graph, name: str | None = None, *, space: str = NAMESPACE) -> list[Pair]:
    """The pairs whose two nodes and topic (called `name`, if given) are all in the namespace `space`."""
    return [
        (one, other)
        for one, other in pairs(graph)
        if all(_is_under(each, space) for each in (one.topic, one.node, other.node))
        and (name is None or one.topic.endswith(f"/{name}"))
    ]


def has_pair_in_namespace(graph: Graph) -> bool:
    """Whether a publisher and a subscription of two nodes are in `NAMESPACE`, on any topics there."""
    return any(
        _are_different_nodes(graph, one.node, other.node)
        for one in publishers(graph)
        for other in subscriptions(graph)
        if all(_is_under(name, NAMESPACE) for each in (one, other) for name in (each.node, each.topic))
    )


def _is_under(name: str, space: str) -> bool:
    return name.startswith(f"/{space}/") and not is_namespace_doubled(name, space)


def is_namespace_doubled(name: str, space: str) -> bool:
    """Whether the name has the namespace as a prefix twice, as in /robot1/robot1/talker."""
    return name.startswith(f"/{space}/{space}/")


def count_entities(graph: Graph) -> tuple[int, int, int]:
    """The numbers of nodes, publishers and subscriptions."""
    return len(graph.nodes), len(publishers(graph)), len(subscriptions(graph))


def logs_of_messages(pair: Pair, logs: Sequence[LogRecord], samples: Sequence[Sample]) -> list[LogRecord]:
    """The subscriber's log messages that quote the content of a sample received by then.

    A number or a few letters may be in any log message by chance: they count only if two different ones are quoted.
    """
    name = pair[1].node.strip("/").replace("/", ".")
    node_logs = [log for log in logs if log.name == name or log.name.startswith(f"{name}.")]
    quoted = {
        log: {
            text
            for sample in samples
            if sample.source_time <= log.stamp + 0.01
            for text in _quoted_values(log.text, sample)
        }
        for log in node_logs
    }
    distinct = set().union(*quoted.values())
    telling = any(len(text) >= _TELLING_LENGTH and not _NUMBER.fullmatch(text) for text in distinct)
    return [log for log in node_logs if quoted[log]] if telling or len(distinct) > 1 else []


def _quoted_values(text: str, sample: Sample) -> Iterator[str]:
    """The values of a message that occur in the text as whole words."""
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
