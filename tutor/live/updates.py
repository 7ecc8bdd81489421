"""What the watcher reports to the app, as plain data. Times `at` and `t` are seconds since the epoch."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tutor.ros_model import Field, Parameter, QoS


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
    """The state of a followed topic.

    `count` is exact: every message received since following began, or the last clear. `lost` counts those sent but
    never received, by the publisher's sequence numbers (None with several publishers). `silent_s` is the time
    since the last message. `text` is the newest one as `ros2 topic echo` writes it, None where there is no newer one.
    `points` are (t, value) of `field`, a sample of what arrived since the last update. `problem`: why nothing can come.
    """

    topic: str
    type: str
    qos: QoS
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
    """The parameters of one node; `answered` is False where it did not answer (it does not spin)."""

    node: str
    answered: bool
    parameters: tuple[Parameter, ...] = ()


@dataclass(frozen=True, slots=True)
class SetOutcome:
    """The result of setting one parameter. `reason` is the node's own."""

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
class RequestForm:
    """The fields of a service's request, or of a message. `problem` says why they are not known."""

    type: str
    fields: tuple[Field, ...] = ()
    problem: str = ""


@dataclass(frozen=True, slots=True)
class CallOutcome:
    """The result of a call. `text` is the response as YAML, None where none came; `problem` says why."""

    id: int
    service: str
    request: Mapping[str, Any]
    text: str | None
    problem: str
    at: float
    took_s: float


@dataclass(frozen=True, slots=True)
class PublishStatus:
    """The state of publishing on a topic. `rate_hz` is 0 for once. `over`: nothing more is sent; `problem` says why.

    `listeners` is the number of the learner's subscriptions.
    """

    topic: str
    type: str
    rate_hz: float
    sent: int
    listeners: int
    at: float
    over: bool = False
    problem: str = ""
