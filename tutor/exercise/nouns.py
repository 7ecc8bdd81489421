"""What an exercise talks about: the learner's programs, and the topics, parameters and services of their nodes."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from tutor.judge.bench import Run
from tutor.judge.trace import Sample, Trace
from tutor.ros_model import Graph

Value = bool | int | float | str
"""What a parameter can be set to."""

FLOAT32 = 1e-6
"""How much a number changes, relatively, if it is kept in 32 bits."""

GOAL_SERVICE, GOAL_TYPE = "/_action/send_goal", "_SendGoal"
"""How the name and the type end of the service by which an action server gets its goals."""

_TYPES = {bool: "boolean", int: "integer", float: "double", str: "string"}


@dataclass(frozen=True)
class Program:
    """A program that the learner writes. `file`: its file, as the lesson names it."""

    file: str


@dataclass(frozen=True)
class LaunchFile:
    """A launch file that the learner writes, which `ros2 launch` runs. `file`: its file, as the lesson names it.

    Files of the submission that are beside it are there when it runs, such as nodes of the learner's own.
    """

    file: str


@dataclass(frozen=True)
class Topic:
    """A topic with its full name and type, such as "/chatter" and "std_msgs/msg/String".

    Raises ValueError unless both are full. `field`: the field that is judged, with dots into nested messages
    ("pose.position.x"). `unit`: of its values, as it is to be shown. `low` and `high`: the range that they must be in,
    both ends included.
    """

    name: str
    type: str
    field: str = "data"
    unit: str = ""
    low: float | None = None
    high: float | None = None

    def __post_init__(self) -> None:
        _require_full_name("topic", self.name, self.type, "msg")

    @property
    def watched(self) -> dict[str, str]:
        """The topic and its type, as the bench wants to know what to subscribe to."""
        return {self.name: self.type}

    def value(self, sample: Sample) -> Any:
        """The value of `field` in a message."""
        value: Any = sample.message
        for name in self.field.split("."):
            value = value[name]
        return value

    def message(self, value: Any) -> dict[str, Any]:
        """The fields of a message whose `field` has this value."""
        *outer, last = self.field.split(".")
        message = {last: value}
        for name in reversed(outer):
            message = {name: message}
        return message

    def values(self, seen: Run | Trace) -> list[Any]:
        """The values of `field` in all messages of a run so far."""
        return [self.value(sample) for sample in seen.samples_on(self.name)]

    def show(self, sample: Sample) -> str:
        """The field of a message as `ros2 topic echo` prints it."""
        return f"{self.field.rpartition('.')[2]}: {self.value(sample)}"

    def has_publisher(self, run: Run) -> bool:
        """Whether the node has a publisher on this topic, of whatever type."""
        return any(publisher.topic == self.name for publisher in run.graph.publishers)


@dataclass(frozen=True)
class ShownIn:
    """The effect of a parameter whose value is in the messages: a text as a part of the field, others as they are."""

    topic: Topic

    def shows(self, value: Value, sample: Sample) -> bool:
        """Whether a message shows this value."""
        shown = self.topic.value(sample)
        return value in str(shown) if isinstance(value, str) else bool(shown == value)


@dataclass(frozen=True)
class SetsRate:
    """The effect of a parameter that sets a topic's rate, in Hz."""

    topic: Topic


@dataclass(frozen=True)
class SwitchesOff:
    """The effect of a parameter that stops a topic's messages while it is false."""

    topic: Topic


Effect = ShownIn | SetsRate | SwitchesOff


@dataclass(frozen=True)
class Parameter:
    """A parameter with its name and default, whose type is the parameter's type, and what it does.

    Raises ValueError for a default of another type than bool, int, float and str.
    """

    name: str
    default: Value
    effect: Effect | None = None

    def __post_init__(self) -> None:
        if type(self.default) not in _TYPES:
            raise ValueError(f"the parameter {self.name}: its default must be a bool, an int, a float or a text")

    @property
    def type(self) -> str:
        """Its type as ROS calls it: "boolean", "integer", "double" or "string"."""
        return _TYPES[type(self.default)]


@dataclass(frozen=True)
class Service:
    """A service with its full name and type. Raises ValueError unless both are full.

    `request`: the fields of the request, in the order of the arguments of `computes`, the function that gives the right
    value of the field `response`. `sign`: how a request of two numbers is shown, as in "6 + 3".
    """

    name: str
    type: str
    request: tuple[str, ...] = ()
    response: str = ""
    computes: Callable[..., Any] | None = None
    sign: str = ""

    def __post_init__(self) -> None:
        _require_full_name("service", self.name, self.type, "srv")


@dataclass(frozen=True)
class Action:
    """An action with its full name and type, such as "/fibonacci" and "example_interfaces/action/Fibonacci".

    Raises ValueError unless both are full.
    """

    name: str
    type: str

    def __post_init__(self) -> None:
        _require_full_name("action", self.name, self.type, "action")

    def has_server(self, graph: Graph) -> bool:
        """Whether the graph has a server of this action."""
        return any((server.name, server.type) == self.goal_service for server in graph.servers)

    @property
    def goal_service(self) -> tuple[str, str]:
        """The service by which goals are sent, by its name and type, as the graph shows it."""
        return f"{self.name}{GOAL_SERVICE}", f"{self.type}{GOAL_TYPE}"


@dataclass(frozen=True)
class Lifecycle:
    """A lifecycle node with its full name, such as "/camera", and what it publishes while it is active.

    `topic`: made when the node is configured, and gone after a cleanup. `rate`: the parameter that is read whenever the
    node is configured; its effect is `SetsRate(topic)`.

        CAMERA = Lifecycle("/camera", IMAGES, Parameter("frame_rate", 5.0, SetsRate(IMAGES)))

    Raises ValueError for a name without a slash, and for a parameter that does not set the topic's rate.
    """

    node: str
    topic: Topic
    rate: Parameter

    def __post_init__(self) -> None:
        if not self.node.startswith("/"):
            raise ValueError(f"the node {self.node}: give its full name, /{self.node}")
        if self.rate.effect != SetsRate(self.topic):
            raise ValueError(f"the parameter {self.rate.name}: its effect must be SetsRate of {self.topic.name}")

    @property
    def default_hz(self) -> float:
        """The rate of a node that is activated without another value of the parameter."""
        return float(self.rate.default)


def _require_full_name(what: str, name: str, type_name: str, kind: str) -> None:
    """Raise ValueError unless a name begins with a slash, and a type is one such as "std_msgs/msg/String"."""
    if not name.startswith("/"):
        raise ValueError(f"the {what} {name}: give its full name, /{name}")
    package, _, rest = type_name.partition(f"/{kind}/")
    if not package or not rest or "/" in package + rest:
        raise ValueError(f"the {what} {name}: {type_name!r} is no type such as package/{kind}/Name")


def agrees(value: Any, wanted: Any) -> bool:
    """Whether a field has the wanted value: floats as nearly as 32 bits hold them, of a mapping the fields it names."""
    if isinstance(wanted, Mapping):
        return isinstance(value, Mapping) and all(k in value and agrees(value[k], w) for k, w in wanted.items())
    if isinstance(wanted, list | tuple):
        return isinstance(value, list | tuple) and len(value) == len(wanted) and all(map(agrees, value, wanted))
    if isinstance(wanted, float) and isinstance(value, int | float):
        return math.isclose(value, wanted, rel_tol=FLOAT32, abs_tol=FLOAT32)
    return bool(value == wanted)


def show(value: object) -> str:
    """A parameter's value as it is written on the command line."""
    return str(value).lower() if isinstance(value, bool) else repr(value) if isinstance(value, str) else str(value)
