"""The ROS graph: nodes, and the endpoints that connect them. A `node` is a fully qualified name, `/robot1/talker`."""

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
        """The parts of a fully qualified name; its first slash may be left out."""
        namespace, _, name = full.rpartition("/")
        return cls(name, f"/{namespace.strip('/')}")

    @property
    def full(self) -> str:
        """The fully qualified name, such as `/robot1/talker`."""
        return f"{self.namespace.rstrip('/')}/{self.name}"


def is_standard_topic(name: str) -> bool:
    """Whether it is one of the topics that every node has."""
    return name in ("/rosout", "/parameter_events")


@dataclass(frozen=True, slots=True)
class TopicEndpoint:
    """A publisher or a subscription of a node."""

    topic: str
    type: str
    node: str
    qos: QoS = field(default_factory=QoS)


@dataclass(frozen=True, slots=True)
class ServiceEndpoint:
    """A service server or client of a node. `reliability` is that of what it sends: answers, or requests."""

    name: str
    type: str
    node: str
    reliability: str = "reliable"

    @property
    def is_standard(self) -> bool:
        """Whether it is one that nodes have by themselves, such as those of their parameters."""
        return _is_standard_type(self.type)


@dataclass(frozen=True, slots=True)
class Topic:
    """A topic with its endpoints."""

    name: str
    publishers: tuple[TopicEndpoint, ...] = ()
    subscriptions: tuple[TopicEndpoint, ...] = ()

    @property
    def types(self) -> tuple[str, ...]:
        """The types that its endpoints use, each once; more than one is a mistake."""
        return tuple(dict.fromkeys(end.type for end in (*self.publishers, *self.subscriptions)))

    @property
    def is_standard(self) -> bool:
        """Whether every node has it."""
        return is_standard_topic(self.name)


@dataclass(frozen=True, slots=True)
class Service:
    """A service with its types, and the nodes that offer it."""

    name: str
    types: tuple[str, ...]
    nodes: tuple[str, ...]

    @property
    def is_standard(self) -> bool:
        """Whether nodes offer it by themselves, such as those of their parameters."""
        return all(map(_is_standard_type, self.types))


@dataclass(frozen=True, slots=True)
class Graph:
    """The graph without what is ours. A name is in `nodes` once for each node that has it."""

    nodes: tuple[str, ...] = ()
    publishers: tuple[TopicEndpoint, ...] = ()
    subscriptions: tuple[TopicEndpoint, ...] = ()
    servers: tuple[ServiceEndpoint, ...] = ()
    clients: tuple[ServiceEndpoint, ...] = ()

    @property
    def topics(self) -> tuple[Topic, ...]:
        """Every topic with an endpoint, by name."""
        ends: dict[str, tuple[list[TopicEndpoint], list[TopicEndpoint]]] = {}
        for place, endpoints in enumerate((self.publishers, self.subscriptions)):
            for end in endpoints:
                ends.setdefault(end.topic, ([], []))[place].append(end)
        return tuple(Topic(name, tuple(ends[name][0]), tuple(ends[name][1])) for name in sorted(ends))

    @property
    def services(self) -> tuple[Service, ...]:
        """Every service with a server, by name."""
        offered: dict[str, list[ServiceEndpoint]] = {}
        for server in self.servers:
            offered.setdefault(server.name, []).append(server)
        return tuple(
            Service(
                name,
                tuple(dict.fromkeys(server.type for server in offered[name])),
                tuple(dict.fromkeys(server.node for server in offered[name])),
            )
            for name in sorted(offered)
        )

    @property
    def parameter_nodes(self) -> tuple[str, ...]:
        """The nodes that offer their parameters over services."""
        return tuple(
            dict.fromkeys(
                server.name.removesuffix("/list_parameters")
                for server in self.servers
                if server.type == "rcl_interfaces/srv/ListParameters"
            )
        )

    def topic(self, name: str) -> Topic | None:
        """The topic of this name, if it has an endpoint."""
        publishers = tuple(end for end in self.publishers if end.topic == name)
        subscriptions = tuple(end for end in self.subscriptions if end.topic == name)
        return Topic(name, publishers, subscriptions) if publishers or subscriptions else None


@dataclass(frozen=True, slots=True)
class Connection:
    """A publisher and a subscription of one topic; `problems` say why no message gets from one to the other."""

    topic: str
    publisher: TopicEndpoint
    subscription: TopicEndpoint
    problems: tuple[str, ...]


def connections(topic: Topic) -> Iterator[Connection]:
    """Every pair of a publisher and a subscription of a topic."""
    for publisher in topic.publishers:
        for subscription in topic.subscriptions:
            yield Connection(topic.name, publisher, subscription, tuple(_problems(publisher, subscription)))


def _problems(publisher: TopicEndpoint, subscription: TopicEndpoint) -> Iterator[str]:
    """Why these two are not connected, each reason as sentences."""
    if publisher.type != subscription.type:
        yield (
            f"The types differ: the publisher sends {publisher.type}, the subscription expects {subscription.type}. "
            "They are not connected."
        )
        return
    for mismatch in incompatible_policies(publisher.qos, subscription.qos):
        yield f"{_capitalised(str(mismatch))}. {_capitalised(mismatch.hint)}."


def _is_standard_type(name: str) -> bool:
    return name.startswith(("rcl_interfaces/", "type_description_interfaces/"))


def _capitalised(text: str) -> str:
    return text[:1].upper() + text[1:]
