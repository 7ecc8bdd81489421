"""The learner's part of the ROS graph, as plain facts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.topic_endpoint_info import TopicEndpointInfo

from tutor.judge.trace import Endpoint, Graph, Service
from tutor.ros.observer import OUR_PREFIX

_AskByNode = Callable[[str, str], Sequence[tuple[str, Sequence[str]]]]

_PLUMBING = ("/rosout", "/parameter_events")
_INFINITE_S = 1e9


def full_name(name: str, namespace: str) -> str:
    """A node's full name, from its name and namespace."""
    return f"{namespace.rstrip('/')}/{name}"


def read_graph(node: Node) -> Graph:
    """What `node` sees of the graph, without our own nodes and without the topics that every node has."""
    nodes = sorted(
        full_name(name, namespace)
        for name, namespace in node.get_node_names_and_namespaces()
        if not name.startswith(OUR_PREFIX)
    )
    topics = [topic for topic, _ in node.get_topic_names_and_types() if topic not in _PLUMBING]
    return Graph(
        nodes=tuple(nodes),
        publishers=_endpoints(topics, node.get_publishers_info_by_topic),
        subscriptions=_endpoints(topics, node.get_subscriptions_info_by_topic),
        services=_services(node, set(nodes), node.get_service_names_and_types_by_node, "rr{}Reply"),
        clients=_services(node, set(nodes), node.get_client_names_and_types_by_node, "rq{}Request"),
    )


def _endpoints(topics: Iterable[str], ask: object) -> tuple[Endpoint, ...]:
    assert callable(ask)
    return tuple(
        _endpoint(topic, info) for topic in topics for info in ask(topic) if not info.node_name.startswith(OUR_PREFIX)
    )


def _endpoint(topic: str, info: TopicEndpointInfo) -> Endpoint:
    return Endpoint(
        topic=topic,
        type=info.topic_type,
        node=full_name(info.node_name, info.node_namespace),
        reliability=info.qos_profile.reliability.short_key,
        durability=info.qos_profile.durability.short_key,
        deadline_s=finite_s(info.qos_profile.deadline),
        liveliness=info.qos_profile.liveliness.short_key,
        lease_s=finite_s(info.qos_profile.liveliness_lease_duration),
    )


def finite_s(duration: Duration) -> float | None:
    """A duration of a QoS policy in seconds; None where it is infinite, or was left to the default."""
    seconds = duration.nanoseconds * 1e-9
    return seconds if 0 < seconds < _INFINITE_S else None


def _services(node: Node, nodes: set[str], ask: _AskByNode, sends_on: str) -> tuple[Service, ...]:
    """The service servers or clients; `sends_on` is the DDS topic of what they send, with {} for the service's name."""
    found: list[Service] = []
    for full in sorted(nodes):
        namespace, _, name = full.rpartition("/")
        try:
            offered = ask(name, namespace or "/")
        except RuntimeError:  # the node left between the two questions
            continue
        for service, types in offered:
            reliability = _reliability(node, sends_on.format(service), full) if _is_own(types) else "reliable"
            found += [Service(service, type_name, full, reliability) for type_name in types]
    return tuple(found)


def _is_own(types: Iterable[str]) -> bool:
    return not any(each.startswith(("rcl_interfaces/", "type_description_interfaces/")) for each in types)


def _reliability(node: Node, dds_topic: str, full: str) -> str:
    senders = node.get_publishers_info_by_topic(dds_topic, no_mangle=True)
    mine = [info for info in senders if full_name(info.node_name, info.node_namespace) == full]
    return mine[0].qos_profile.reliability.short_key if mine else "reliable"
