"""What is seen on the user's domain, as plain data. Times `at` and `t` are seconds since the epoch."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tutor.judge.trace import Parameter


@dataclass(frozen=True, slots=True)
class Qos:
    """The policies that decide whether two endpoints match. `deadline_s` and `lease_s` are None where infinite."""

    reliability: str = "reliable"
    durability: str = "volatile"
    deadline_s: float | None = None
    liveliness: str = "automatic"
    lease_s: float | None = None

    def __str__(self) -> str:
        words = [self.reliability.replace("_", " "), self.durability.replace("_", " ")]
        if self.deadline_s is not None:
            words.append(f"deadline {self.deadline_s:g} s")
        if self.liveliness != "automatic":
            words.append(f"liveliness {self.liveliness.replace('_', ' ')}")
        return ", ".join(words)


@dataclass(frozen=True, slots=True)
class Endpoint:
    """A publisher or a subscription of a node (its full name)."""

    node: str
    type: str
    qos: Qos = Qos()


@dataclass(frozen=True, slots=True)
class Topic:
    """A topic with its endpoints; our own are left out."""

    name: str
    publishers: tuple[Endpoint, ...] = ()
    subscriptions: tuple[Endpoint, ...] = ()

    @property
    def types(self) -> tuple[str, ...]:
        """Every type that somebody uses on it, each once; more than one is a mistake."""
        return tuple(dict.fromkeys(end.type for end in (*self.publishers, *self.subscriptions)))


@dataclass(frozen=True, slots=True)
class Service:
    """A service, its types, and the nodes that offer it."""

    name: str
    types: tuple[str, ...]
    nodes: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Graph:
    """The whole domain but ourselves. A name stands in `nodes` once for each node that has it."""

    nodes: tuple[str, ...] = ()
    topics: tuple[Topic, ...] = ()
    services: tuple[Service, ...] = ()

    def topic(self, name: str) -> Topic | None:
        """The topic of this name, if it is there."""
        return next((topic for topic in self.topics if topic.name == name), None)


@dataclass(frozen=True, slots=True)
class Timing:
    """The periods between the messages of the last seconds, by their source timestamps; all in seconds."""

    periods: int
    mean_s: float
    deviation_s: float
    shortest_s: float
    longest_s: float

    @property
    def rate_hz(self) -> float:
        """Messages per second; 0 where all came at the same instant."""
        return 1 / self.mean_s if self.mean_s > 0 else 0.0


@dataclass(frozen=True, slots=True)
class TopicUpdate:
    """How a followed topic stands.

    `count` is exact: every message that was received since following began, or the last clear. `lost` are those that
    were sent and never arrived, as the publisher's numbers tell (None with several publishers). `silent_s` is the time
    since the last message. `text` is the newest one as `ros2 topic echo` writes it, None where there is no newer one.
    `points` are (t, value) of `field`, a sample of what arrived since the last update. `problem`: why nothing can come.
    """

    topic: str
    type: str
    qos: Qos
    count: int
    lost: int | None
    timing: Timing | None
    silent_s: float | None
    text: str | None = None
    fields: tuple[str, ...] = ()
    field: str = ""
    points: tuple[tuple[float, float], ...] = ()
    problem: str = ""


@dataclass(frozen=True, slots=True)
class NodeParameters:
    """The parameters of one node, or that it does not answer (it does not spin)."""

    node: str
    answered: bool
    parameters: tuple[Parameter, ...] = ()


@dataclass(frozen=True, slots=True)
class SetOutcome:
    """What became of setting one parameter. `reason` is the node's own."""

    id: int
    node: str
    name: str
    value: Any
    answered: bool
    accepted: bool
    reason: str
    at: float
    took_s: float


@dataclass(frozen=True, slots=True)
class Field:
    """One leaf of a request: its path with dots, its type as ROS names it, and its default as text."""

    path: str
    type: str
    default: str


@dataclass(frozen=True, slots=True)
class RequestForm:
    """What a service asks for, or what a message holds. `problem` says why it is not known."""

    type: str
    fields: tuple[Field, ...] = ()
    problem: str = ""


@dataclass(frozen=True, slots=True)
class CallOutcome:
    """What became of a call. `text` is the answer as YAML, None where none came; `problem` says why."""

    id: int
    service: str
    request: Mapping[str, Any]
    text: str | None
    problem: str
    at: float
    took_s: float


@dataclass(frozen=True, slots=True)
class Published:
    """How publishing on a topic stands. `rate_hz` is 0 for once. `over`: nothing more is sent; `problem` says why.

    `listeners` are the subscriptions of the learner's nodes when it was last looked.
    """

    topic: str
    type: str
    rate_hz: float
    sent: int
    listeners: int
    at: float
    over: bool = False
    problem: str = ""
