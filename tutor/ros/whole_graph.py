"""The whole domain with each endpoint's QoS, as plain facts; and the QoS that `ros2 topic echo` would choose."""

from __future__ import annotations

from collections.abc import Callable

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.topic_endpoint_info import TopicEndpointInfo

from tutor.live.facts import Endpoint, Graph, Qos, Service, Topic
from tutor.ros.graph import finite_s, full_name
from tutor.ros.observer import OUR_PREFIX


def read_whole_graph(node: Node) -> Graph:
    """What `node` sees, without our own nodes and endpoints."""
    nodes = sorted(
        (name, namespace) for name, namespace in node.get_node_names_and_namespaces() if not name.startswith(OUR_PREFIX)
    )
    topics = (_topic(node, name) for name, _ in sorted(node.get_topic_names_and_types()))
    return Graph(
        nodes=tuple(sorted(full_name(name, namespace) for name, namespace in nodes)),
        topics=tuple(topic for topic in topics if topic.publishers or topic.subscriptions),
        services=_services(node, nodes),
    )


def graph_fingerprint(node: Node) -> object:
    """Something that differs where the graph does, but for an endpoint that was replaced: much cheaper to get."""
    topics = node.get_topic_names_and_types()
    return (
        node.get_node_names_and_namespaces(),
        [(name, types, node.count_publishers(name), node.count_subscribers(name)) for name, types in topics],
        [name for name, _ in node.get_service_names_and_types()],
    )


def echo_qos(topic: Topic) -> tuple[ReliabilityPolicy, DurabilityPolicy]:
    """What `ros2 topic echo` subscribes with: what every publisher offers, else the weaker."""
    offered = [publisher.qos for publisher in topic.publishers]
    reliable = all(qos.reliability == "reliable" for qos in offered)
    kept = bool(offered) and all(qos.durability == "transient_local" for qos in offered)
    return (
        ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        DurabilityPolicy.TRANSIENT_LOCAL if kept else DurabilityPolicy.VOLATILE,
    )


def _topic(node: Node, name: str) -> Topic:
    return Topic(
        name,
        _endpoints(name, node.get_publishers_info_by_topic),
        _endpoints(name, node.get_subscriptions_info_by_topic),
    )


def _endpoints(topic: str, ask: Callable[[str], list[TopicEndpointInfo]]) -> tuple[Endpoint, ...]:
    found = [
        Endpoint(full_name(info.node_name, info.node_namespace), info.topic_type, _qos(info.qos_profile))
        for info in ask(topic)
        if not info.node_name.startswith(OUR_PREFIX)
    ]
    return tuple(sorted(found, key=lambda end: (end.node, end.type, str(end.qos))))


def _qos(profile: QoSProfile) -> Qos:
    return Qos(
        reliability=profile.reliability.short_key,
        durability=profile.durability.short_key,
        deadline_s=finite_s(profile.deadline),
        liveliness=profile.liveliness.short_key,
        lease_s=finite_s(profile.liveliness_lease_duration),
    )


def _services(node: Node, nodes: list[tuple[str, str]]) -> tuple[Service, ...]:
    types: dict[str, dict[str, None]] = {}
    offered: dict[str, list[str]] = {}
    for name, namespace in nodes:
        try:
            found = node.get_service_names_and_types_by_node(name, namespace or "/")
        except RuntimeError:  # the node left between the two questions
            continue
        for service, of in found:
            types.setdefault(service, {}).update(dict.fromkeys(of))
            offered.setdefault(service, []).append(full_name(name, namespace))
    return tuple(Service(name, tuple(types[name]), tuple(dict.fromkeys(offered[name]))) for name in sorted(types))
