"""What the app and the watcher process exchange: one JSON object per line, named by its class."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, get_args

from tutor.json_codec import LineCodec
from tutor.live.updates import CallOutcome, NodeParameters, PublishStatus, RequestForm, SetOutcome, TopicUpdate
from tutor.ros_model import Graph

# --- requests: from the app ---


@dataclass(frozen=True, slots=True)
class Follow:
    """Subscribe to a topic, as soon as it has a type."""

    topic: str


@dataclass(frozen=True, slots=True)
class Unfollow:
    """Stop following a topic."""

    topic: str


@dataclass(frozen=True, slots=True)
class Clear:
    """Reset a topic's count and statistics."""

    topic: str


@dataclass(frozen=True, slots=True)
class Plot:
    """Sample this numeric field of a followed topic."""

    topic: str
    field: str


@dataclass(frozen=True, slots=True)
class SetVisible:
    """Whether the Live page is on screen. While it is not, messages are counted, but no topic updates are sent."""

    visible: bool


@dataclass(frozen=True, slots=True)
class Refresh:
    """Read the graph now, and ask every node for its parameters."""


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
    """Call a service; `request` maps field paths to values. Answered by a CallOutcome of the same id."""

    id: int
    service: str
    type: str
    request: Mapping[str, Any]
    limit_s: float


@dataclass(frozen=True, slots=True)
class Cancel:
    """Stop waiting for the answer to a call. Answered by its CallOutcome."""

    id: int


@dataclass(frozen=True, slots=True)
class Publish:
    """Publish a message once (`rate_hz` 0) or `rate_hz` times a second, replacing what is published on the topic now.

    `values` maps field paths to values. Answered by PublishStatus, repeatedly while it goes on.
    """

    topic: str
    type: str
    values: Mapping[str, Any]
    rate_hz: float


@dataclass(frozen=True, slots=True)
class StopPublishing:
    """Stop publishing on a topic. Answered by a PublishStatus."""

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
    """The watcher has joined the domain."""

    domain: int


@dataclass(frozen=True, slots=True)
class WatcherError:
    """Something went wrong in the watcher; one line."""

    text: str


Update = (
    Ready | WatcherError | Graph | TopicUpdate | NodeParameters | SetOutcome | RequestForm | CallOutcome | PublishStatus
)

_REQUESTS: LineCodec[WatcherRequest] = LineCodec("kind", get_args(WatcherRequest))
_UPDATES: LineCodec[Update] = LineCodec("kind", get_args(Update))

encode_request, decode_request = _REQUESTS.encode, _REQUESTS.decode
encode_update, decode_update = _UPDATES.encode, _UPDATES.decode
