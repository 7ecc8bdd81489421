"""Reads the ROS graph, as seen by our node, into plain data."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from rclpy.node import Node
from rclpy.topic_endpoint_info import TopicEndpointInfo

from tutor.ros.participant import OUR_PREFIX
from tutor.ros.qos import from_rclpy
from tutor.ros_model import Graph, NodeName, QoS, ServiceEndpoint, TopicEndpoint, is_standard_topic

_NamesAndTypes = Sequence[tuple[str, Sequence[str]]]


def read_graph(node: Node, *, standard_topics: bool = False) -> Graph:
    """Return the graph as `node` sees it, without our own nodes. `standard_topics`: include those of every node."""
    nodes = sorted(
        NodeName(name, namespace).full
        for name, namespace in node.get_node_names_and_namespaces()
        if not name.startswith(OUR_PREFIX)
    )
    topics = [name for name, _ in node.get_topic_names_and_types() if standard_topics or not is_standard_topic(name)]
    return Graph(
        nodes=tuple(nodes),
        publishers=_topic_endpoints(topics, node.get_publishers_info_by_topic),
        subscriptions=_topic_endpoints(topics, node.get_subscriptions_info_by_topic),
        servers=_service_endpoints(node, nodes, node.get_service_names_and_types_by_node, "rr{}Reply"),
        clients=_service_endpoints(node, nodes, node.get_client_names_and_types_by_node, "rq{}Request"),
    )


def graph_fingerprint(node: Node) -> object:
    """Return a value that is cheap to get and changes with the graph, unless one endpoint replaces another."""
    return (
        node.get_node_names_and_namespaces(),
        [
            (name, types, node.count_publishers(name), node.count_subscribers(name))
            for name, types in node.get_topic_names_and_types()
        ],
        node.get_service_names_and_types(),
    )


def parameter_event_publishers(node: Node) -> frozenset[tuple[str, bytes]]:
    """Return the name of each node with the DDS id of its publisher of parameter events.

    A node that has replaced another one of the same name has another id.
    """
    return frozenset(
        (_node_of(info), bytes(info.endpoint_gid)) for info in node.get_publishers_info_by_topic("/parameter_events")
    )


def _topic_endpoints(
    topics: Iterable[str], query: Callable[[str], list[TopicEndpointInfo]]
) -> tuple[TopicEndpoint, ...]:
    found = [
        TopicEndpoint(topic, info.topic_type, _node_of(info), from_rclpy(info.qos_profile))
        for topic in topics
        for info in query(topic)
        if not info.node_name.startswith(OUR_PREFIX)
    ]
    return tuple(sorted(found, key=lambda endpoint: (endpoint.topic, endpoint.node, endpoint.type, str(endpoint.qos))))


def _service_endpoints(
    node: Node, nodes: Iterable[str], query: Callable[[str, str], _NamesAndTypes], dds_topic: str
) -> tuple[ServiceEndpoint, ...]:
    """Return the servers or clients of `nodes`. They send on `dds_topic`, where {} stands for the service name."""
    found: list[ServiceEndpoint] = []
    for full in dict.fromkeys(nodes):
        try:
            services = query(*NodeName.parse(full))
        except RuntimeError:  # the node has left the graph meanwhile
            continue
        for service, types in services:
            endpoints = [ServiceEndpoint(service, type_name, full) for type_name in types]
            if not any(endpoint.is_standard for endpoint in endpoints):
                qos = _find_qos(node, dds_topic.format(service), full)
                endpoints = [
                    ServiceEndpoint(service, type_name, full, qos.reliability, qos.durability) for type_name in types
                ]
            found += endpoints
    return tuple(found)


def _find_qos(node: Node, dds_topic: str, full: str) -> QoS:
    senders = node.get_publishers_info_by_topic(dds_topic, no_mangle=True)
    return next((from_rclpy(info.qos_profile) for info in senders if _node_of(info) == full), QoS())


def _node_of(info: TopicEndpointInfo) -> str:
    return NodeName(info.node_name, info.node_namespace).full
