"""What the app and the watching process say to each other: one JSON object to a line, named by its class."""

from __future__ import annotations

import json
import types
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, is_dataclass
from functools import cache
from typing import Any, Union, get_args, get_origin, get_type_hints

from tutor.live.facts import CallOutcome, Graph, NodeParameters, Published, RequestForm, SetOutcome, TopicNews

# --- commands: from the app ---


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
class Attend:
    """Whether anybody looks: without, everything is counted but no news of topics is sent."""

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
    """Publish a message once (`rate_hz` 0) or so many times a second, instead of what is published on the topic now.

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


Command = (
    Follow
    | Unfollow
    | Clear
    | Plot
    | Attend
    | Refresh
    | SetParameter
    | Describe
    | Call
    | Cancel
    | Publish
    | StopPublishing
)

# --- news: to the app ---


@dataclass(frozen=True, slots=True)
class Ready:
    """The child has joined the domain."""

    domain: int


@dataclass(frozen=True, slots=True)
class Trouble:
    """Something went wrong in the child; one line."""

    text: str


News = Ready | Trouble | Graph | TopicNews | NodeParameters | SetOutcome | RequestForm | CallOutcome | Published

_KINDS: dict[str, type[Any]] = {kind.__name__: kind for kind in (*get_args(Command), *get_args(News))}


def encode(said: Command | News) -> str:
    """Write it as one line of JSON in ASCII, without the line's end."""
    return json.dumps({"kind": type(said).__name__, **asdict(said)})


def decode_command(line: str) -> Command:
    """Read a command. Raises ValueError for a line that is none."""
    command: Command = _decode(line, get_args(Command))
    return command


def decode_news(line: str) -> News:
    """Read news. Raises ValueError for a line that is none."""
    news: News = _decode(line, get_args(News))
    return news


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
