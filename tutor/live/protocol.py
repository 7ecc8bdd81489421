"""What the app and the watching process say to each other: one JSON object to a line, named by its class."""

from __future__ import annotations

import json
import types
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, is_dataclass
from functools import cache
from typing import Any, Union, get_args, get_origin, get_type_hints

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

_KINDS: dict[str, type[Any]] = {kind.__name__: kind for kind in (*get_args(WatcherRequest), *get_args(Update))}


def encode(said: WatcherRequest | Update) -> str:
    """Write it as one line of JSON in ASCII, without the line's end."""
    return json.dumps({"kind": type(said).__name__, **asdict(said)})


def decode_request(line: str) -> WatcherRequest:
    """Read a request. Raises ValueError for a line that is not one."""
    request: WatcherRequest = _decode(line, get_args(WatcherRequest))
    return request


def decode_update(line: str) -> Update:
    """Read an update. Raises ValueError for a line that is not one."""
    update: Update = _decode(line, get_args(Update))
    return update


def _decode(line: str, expected: tuple[Any, ...]) -> Any:
    try:
        given = json.loads(line)
        kind = _KINDS[given.pop("kind")]
        if kind not in expected:
            raise KeyError(kind.__name__)
        return _build(kind, given)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise ValueError(f"not understood: {line[:200]!r}") from error


def _build(kind: Any, value: Any) -> Any:
    """A value as JSON gives it, as what the annotation `kind` says: dataclasses and tuples are made again."""
    if is_dataclass(kind):
        built: Any = kind
        annotated = _annotations(built)
        return built(**{name: _build(annotated[name], item) for name, item in value.items()})
    origin, of = get_origin(kind), get_args(kind)
    if origin is tuple:
        return tuple(_build(of[0] if of[-1] is ... else of[n], item) for n, item in enumerate(value))
    if origin in (Union, types.UnionType):
        return None if value is None else _build(next(one for one in of if one is not type(None)), value)
    return value


@cache
def _annotations(kind: type[Any]) -> dict[str, Any]:
    hints = get_type_hints(kind)
    return {field.name: hints[field.name] for field in fields(kind)}
