"""The graph of a launch: its pairs of a publisher and a subscription, their topics and namespaces."""

from __future__ import annotations

from collections.abc import Iterable

from tutor.ros_model import Graph, TopicEndpoint, is_standard_topic

Pair = tuple[TopicEndpoint, TopicEndpoint]
"""A publisher and a subscription of two different nodes, usually on the same topic."""


def publishers(graph: Graph) -> list[TopicEndpoint]:
    """The publishers, except those that ROS creates itself."""
    return [publisher for publisher in graph.publishers if not _is_standard(publisher.topic)]


def subscriptions(graph: Graph) -> list[TopicEndpoint]:
    """The subscriptions, except those that ROS creates itself."""
    return [subscription for subscription in graph.subscriptions if not _is_standard(subscription.topic)]


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
    return {endpoint.topic for endpoint in (*publishers(graph), *subscriptions(graph))}


def shared_topics(graph: Graph) -> set[str]:
    """The topics that connect one node's publisher to another node's subscription."""
    return {one.topic for one, _ in pairs(graph)}


def shared_namespaces(graph: Graph) -> set[str]:
    """The namespaces that contain both nodes of a pair and their topic, such as "/demo"; "" is the root."""
    spaces = {(one.topic, endpoint.node.rpartition("/")[0]) for one, other in pairs(graph) for endpoint in (one, other)}
    return {space for topic, space in spaces if topic.startswith(f"{space}/")}


def pairs_on_topic(graph: Graph, name: str, within: Iterable[str] = ()) -> list[Pair]:
    """The pairs on /name, or on /namespace/name for one of the namespaces in `within`."""
    wanted = {f"{space}/{name}" for space in ("", *within)}
    return [pair for pair in pairs(graph) if pair[0].topic in wanted]


def pairs_on_topic_named(graph: Graph, name: str) -> list[Pair]:
    """The pairs on a topic with this name, in any namespace."""
    return [pair for pair in pairs(graph) if pair[0].topic.endswith(f"/{name}")]


def pairs_in_namespace(graph: Graph, space: str, name: str = "") -> list[Pair]:
    """The pairs whose two nodes and topic (called `name`, if given) are all in the namespace `space`."""
    return [
        (one, other)
        for one, other in pairs(graph)
        if all(_is_under(name, space) for name in (one.topic, one.node, other.node))
        and (not name or one.topic.endswith(f"/{name}"))
    ]


def has_pair_in_namespace(graph: Graph, space: str) -> bool:
    """Whether a publisher and a subscription of two nodes are in this namespace, on any topics there."""
    return any(
        _are_different_nodes(graph, one.node, other.node)
        for one in publishers(graph)
        for other in subscriptions(graph)
        if all(_is_under(name, space) for endpoint in (one, other) for name in (endpoint.node, endpoint.topic))
    )


def _is_under(name: str, space: str) -> bool:
    return name.startswith(f"/{space}/") and not is_namespace_doubled(name, space)


def is_namespace_doubled(name: str, space: str) -> bool:
    """Whether the name has the namespace as a prefix twice, as in /robot1/robot1/talker."""
    return name.startswith(f"/{space}/{space}/")


def count_entities(graph: Graph) -> tuple[int, int, int]:
    """The numbers of nodes, publishers and subscriptions."""
    return len(graph.nodes), len(publishers(graph)), len(subscriptions(graph))


def describe_graph(graph: Graph) -> str:
    """Who publishes and subscribes to what."""
    ends = [f"{publisher.node} publishes on {publisher.topic}" for publisher in publishers(graph)]
    ends += [f"{subscription.node} subscribes to {subscription.topic}" for subscription in subscriptions(graph)]
    return "; ".join(sorted(set(ends))) or f"nodes without topics: {', '.join(graph.nodes)}"


def describe_pair(pair: Pair) -> list[str]:
    """What the two nodes of a pair do, a line each."""
    publisher, subscription = pair
    return [
        f"{publisher.node} publishes on {publisher.topic}",
        f"{subscription.node} subscribes to {subscription.topic}",
    ]
