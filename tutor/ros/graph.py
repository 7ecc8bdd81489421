"""The learner's part of the ROS graph, as plain facts."""

from __future__ import annotations

from collections.abc import Iterable

from rclpy.node import Node
from rclpy.topic_endpoint_info import TopicEndpointInfo

from tutor.judge.trace import Endpoint, Graph, Service
from tutor.ros.observer import OUR_PREFIX

_PLUMBING = ("/rosout", "/parameter_events")


def full_name(name: str, namespace: str) -> str:
    """A node's full name, from its name and namespace."""
    return f"{namespace.rstrip('/')}/{name}"


def graph(node: Node) -> Graph:
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
        services=_services(node, set(nodes)),
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
    )


def _services(node: Node, nodes: set[str]) -> tuple[Service, ...]:
    found: list[Service] = []
    for full in sorted(nodes):
        namespace, _, name = full.rpartition("/")
        try:
            offered = node.get_service_names_and_types_by_node(name, namespace or "/")
        except RuntimeError:  # the node left between the two questions
            continue
        found += [Service(service, type_name, full) for service, types in offered for type_name in types]
    return tuple(found)
