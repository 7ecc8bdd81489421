"""What the app and the watching process say to each other: one JSON object to a line, named by its class."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, get_args

from tutor.json_codec import LineCodec
from tutor.live.updates import CallOutcome, NodeParameters, Published, RequestForm, SetOutcome, TopicUpdate
from tutor.ros_model import Graph

# --- requests: from the app ---


@dataclass(frozen=True, slots=True)
class Follow:
    """Subscribe to a topic, as soon as it has a type."""

    topic: str


@dataclass(frozen=True, slots=True)
class Unfollow:
    """End that."""

    topic: str


@dataclass(frozen=True, slots=True)
class Clear:
    """Count from nothing again."""

    topic: str


@dataclass(frozen=True, slots=True)
class Plot:
    """Sample this numeric field of a followed topic."""

    topic: str
    field: str


@dataclass(frozen=True, slots=True)
class SetVisible:
    """Whether anybody looks: without, everything is counted but no updates of topics are sent."""

    seen: bool


@dataclass(frozen=True, slots=True)
class Refresh:
    """Look at the graph now, and ask every node for its parameters."""


@dataclass(frozen=True, slots=True)
class SetParameter:
    """Set a parameter; `type` as `ros2 param describe` names it. Answered by a SetOutcome of the same id."""

    id: int
    node: str
    name: str
    type: str
    value: Any


@dataclass(frozen=True, slots=True)
class Describe:
    """Ask for the form of a service type's request, or of a message type. Answered by a RequestForm."""

    type: str


@dataclass(frozen=True, slots=True)
class Call:
    """Call a service; `request` maps the paths of its fields to values. Answered by a CallOutcome of the same id."""

    id: int
    service: str
    type: str
    request: Mapping[str, Any]
    limit_s: float


@dataclass(frozen=True, slots=True)
class Cancel:
    """Wait for the answer to this call no longer. Answered by its CallOutcome."""

    id: int


@dataclass(frozen=True, slots=True)
class Publish:
    """Publish a message once (`rate_hz` 0) or `rate_hz` times a second, instead of what is published on the topic now.

    `values` are by the paths of its fields. Answered by Published, again and again while it goes on.
    """

    topic: str
    type: str
    values: Mapping[str, Any]
    rate_hz: float


@dataclass(frozen=True, slots=True)
class StopPublishing:
    """Publish on this topic no longer. Answered by a Published."""

    topic: str


WatcherRequest = (
    Follow
    | Unfollow
    | Clear
    | Plot
    | SetVisible
    | Refresh
    | SetParameter
    | Describe
    | Call
    | Cancel
    | Publish
    | StopPublishing
)

# --- updates: to the app ---


@dataclass(frozen=True, slots=True)
class Ready:
    """The child has joined the domain."""

    domain: int


@dataclass(frozen=True, slots=True)
class WatcherError:
    """Something went wrong in the child; one line."""

    text: str


Update = (
    Ready | WatcherError | Graph | TopicUpdate | NodeParameters | SetOutcome | RequestForm | CallOutcome | Published
)

_REQUESTS: LineCodec[WatcherRequest] = LineCodec("kind", get_args(WatcherRequest))
_UPDATES: LineCodec[Update] = LineCodec("kind", get_args(Update))

encode_request, decode_request = _REQUESTS.encode, _REQUESTS.decode
encode_update, decode_update = _UPDATES.encode, _UPDATES.decode
