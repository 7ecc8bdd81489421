"""The ROS graph: nodes and their endpoints. `node` is always a fully qualified name, such as `/robot1/talker`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from tutor.ros_model.qos import QoS, incompatible_policies


class NodeName(NamedTuple):
    """A node's name and namespace, such as `talker` in `/robot1`."""

    name: str
    namespace: str

    @classmethod
    def parse(cls, full: str) -> NodeName:
        """Split a fully qualified name, whose leading slash may be missing."""
        namespace, _, name = full.rpartition("/")
        return cls(name, f"/{namespace.strip('/')}")

    @property
    def full(self) -> str:
        """The fully qualified name, such as `/robot1/talker`."""
        return f"{self.namespace.rstrip('/')}/{self.name}"


def is_standard_topic(name: str) -> bool:
    """Return whether every node has this topic."""
    return name in ("/rosout", "/parameter_events")


def is_hidden(name: str) -> bool:
    """Return whether a node, topic, service or action is hidden: a part of its name begins with `_`."""
    return any(part.startswith("_") for part in name.split("/"))


@dataclass(frozen=True, slots=True)
class TopicEndpoint:
    """A publisher or a subscription of a node."""

    topic: str
    type: str
    node: str
    qos: QoS = field(default_factory=QoS)


@dataclass(frozen=True, slots=True)
class ServiceEndpoint:
    """A service server or client of a node. The QoS is that of its DDS writer (of responses or requests)."""

    name: str
    type: str
    node: str
    reliability: str = "reliable"
    durability: str = "volatile"

    @property
    def is_standard(self) -> bool:
        """Whether nodes create it by default, such as the parameter services."""
        return _is_standard_type(self.type)


@dataclass(frozen=True, slots=True)
class Topic:
    """A topic with its endpoints."""

    name: str
    publishers: tuple[TopicEndpoint, ...] = ()
    subscriptions: tuple[TopicEndpoint, ...] = ()

    @property
    def types(self) -> tuple[str, ...]:
        """The distinct types of its endpoints; more than one is a mistake."""
        return tuple(dict.fromkeys(endpoint.type for endpoint in (*self.publishers, *self.subscriptions)))

    @property
    def is_standard(self) -> bool:
        """Whether every node has this topic."""
        return is_standard_topic(self.name)


@dataclass(frozen=True, slots=True)
class Service:
    """A service with its types and the nodes that offer it."""

    name: str
    types: tuple[str, ...]
    nodes: tuple[str, ...]

    @property
    def is_standard(self) -> bool:
        """Whether nodes create it by default, such as the parameter services."""
        return all(map(_is_standard_type, self.types))


@dataclass(frozen=True, slots=True)
class Graph:
    """The graph without our own nodes. `nodes` repeats a name once for each node that has it."""

    nodes: tuple[str, ...] = ()
    publishers: tuple[TopicEndpoint, ...] = ()
    subscriptions: tuple[TopicEndpoint, ...] = ()
    servers: tuple[ServiceEndpoint, ...] = ()
    clients: tuple[ServiceEndpoint, ...] = ()

    @property
    def topics(self) -> tuple[Topic, ...]:
        """All topics with an endpoint, sorted by name."""
        by_topic: dict[str, tuple[list[TopicEndpoint], list[TopicEndpoint]]] = {}
        for index, endpoints in enumerate((self.publishers, self.subscriptions)):
            for endpoint in endpoints:
                by_topic.setdefault(endpoint.topic, ([], []))[index].append(endpoint)
        return tuple(Topic(name, tuple(by_topic[name][0]), tuple(by_topic[name][1])) for name in sorted(by_topic))

    @property
    def services(self) -> tuple[Service, ...]:
        """All services with a server, sorted by name."""
        by_name: dict[str, list[ServiceEndpoint]] = {}
        for server in self.servers:
            by_name.setdefault(server.name, []).append(server)
        return tuple(
            Service(
                name,
                tuple(dict.fromkeys(server.type for server in by_name[name])),
                tuple(dict.fromkeys(server.node for server in by_name[name])),
            )
            for name in sorted(by_name)
        )

    @property
    def parameter_nodes(self) -> tuple[str, ...]:
        """The nodes with parameter services."""
        return tuple(
            dict.fromkeys(
                server.name.removesuffix("/list_parameters")
                for server in self.servers
                if server.type == "rcl_interfaces/srv/ListParameters"
            )
        )

    def topic(self, name: str) -> Topic | None:
        """Return the topic of this name; None if it has no endpoint."""
        publishers = tuple(endpoint for endpoint in self.publishers if endpoint.topic == name)
        subscriptions = tuple(endpoint for endpoint in self.subscriptions if endpoint.topic == name)
        return Topic(name, publishers, subscriptions) if publishers or subscriptions else None


@dataclass(frozen=True, slots=True)
class Connection:
    """A publisher and a subscription on the same topic; `problems` says why messages do not get through."""

    topic: str
    publisher: TopicEndpoint
    subscription: TopicEndpoint
    problems: tuple[str, ...]


def connections(topic: Topic) -> Iterator[Connection]:
    """Yield every pair of a publisher and a subscription of a topic."""
    for publisher in topic.publishers:
        for subscription in topic.subscriptions:
            yield Connection(topic.name, publisher, subscription, tuple(_problems(publisher, subscription)))


def _problems(publisher: TopicEndpoint, subscription: TopicEndpoint) -> Iterator[str]:
    """Yield the reasons why these two are not connected, each in full sentences."""
    if publisher.type != subscription.type:
        yield (
            f"The types differ: the publisher sends {publisher.type}, the subscription expects {subscription.type}. "
            "They are not connected."
        )
        return
    for mismatch in incompatible_policies(publisher.qos, subscription.qos):
        yield f"{_capitalize(str(mismatch))}. {_capitalize(mismatch.hint)}."


def _is_standard_type(name: str) -> bool:
    return name.startswith(("rcl_interfaces/", "type_description_interfaces/"))


def _capitalize(text: str) -> str:
    return text[:1].upper() + text[1:]
