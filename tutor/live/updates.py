"""Updates from the watcher to the app, as plain data. Times `at` and `t` are in seconds since the epoch."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tutor.ros_model import Field, Parameter, QoS, Timing


@dataclass(frozen=True, slots=True)
class TopicUpdate:
    """The state of a followed topic.

    `count` is the exact number of messages received since following began or the last clear. `lost` counts messages
    sent but never received, by the publisher's sequence numbers (None with several publishers). `silent_s` is the time
    since the last message. `text` is the newest message as `ros2 topic echo` prints it, or None if there is no newer
    one. `points` holds (t, value) of `field`, sampled from what arrived since the last update. `problem` says why no
    message can be shown.
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
    """The parameters of one node; `answered` is False if it did not respond (it does not spin)."""

    node: str
    answered: bool
    parameters: tuple[Parameter, ...] = ()


@dataclass(frozen=True, slots=True)
class SetOutcome:
    """The result of setting one parameter. `reason` comes from the node."""

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
    """The fields of a service's request, or of a message. `problem` says why they are unknown."""

    type: str
    fields: tuple[Field, ...] = ()
    problem: str = ""


@dataclass(frozen=True, slots=True)
class CallOutcome:
    """The result of a call. `text` is the response as YAML, or None if there is none; `problem` says why."""

    id: int
    service: str
    request: Mapping[str, Any]
    text: str | None
    problem: str
    at: float
    took_s: float


@dataclass(frozen=True, slots=True)
class PublishStatus:
    """The state of publishing on a topic. `rate_hz` is 0 for a single message.

    `listeners` is the number of the learner's subscriptions. `over`: nothing more is sent; `problem` says why, if it
    failed.
    """

    topic: str
    type: str
    rate_hz: float
    sent: int
    listeners: int
    at: float
    over: bool = False
    problem: str = ""
