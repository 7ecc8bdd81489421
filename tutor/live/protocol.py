"""The protocol between the app and the watcher process: one JSON object per line, tagged with its class name."""

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
    """Tell whether the Live page is visible. While it is not, messages are counted but no topic updates are sent."""

    visible: bool


@dataclass(frozen=True, slots=True)
class Refresh:
    """Read the graph and the parameters of every node now."""


@dataclass(frozen=True, slots=True)
class SetParameter:
    """Set a parameter; `type` is named as in `ros2 param describe`. Answered by a SetOutcome with the same id."""

    id: int
    node: str
    name: str
    type: str
    value: Any


@dataclass(frozen=True, slots=True)
class Describe:
    """Get the form of a message type, or of a service type's request. Answered by a RequestForm."""

    type: str


@dataclass(frozen=True, slots=True)
class Call:
    """Call a service; `request` maps field paths to values. Answered by a CallOutcome with the same id."""

    id: int
    service: str
    type: str
    request: Mapping[str, Any]
    limit_s: float


@dataclass(frozen=True, slots=True)
class Cancel:
    """Stop waiting for the response to a call. Answered by its CallOutcome."""

    id: int


@dataclass(frozen=True, slots=True)
class Publish:
    """Publish a message once (`rate_hz` 0) or at `rate_hz`, replacing what we currently publish on the topic.

    `values` maps field paths to values. Answered by repeated PublishStatus updates.
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
    """An error in the watcher, in one line."""

    text: str


Update = (
    Ready | WatcherError | Graph | TopicUpdate | NodeParameters | SetOutcome | RequestForm | CallOutcome | PublishStatus
)

_REQUESTS: LineCodec[WatcherRequest] = LineCodec("kind", get_args(WatcherRequest))
_UPDATES: LineCodec[Update] = LineCodec("kind", get_args(Update))

encode_request, decode_request = _REQUESTS.encode, _REQUESTS.decode
encode_update, decode_update = _UPDATES.encode, _UPDATES.decode
