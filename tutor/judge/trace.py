"""Facts: what was observed of a learner's process, as plain data.

Times are seconds. `source_time`, `stamp` and `at` are wall-clock times since the epoch (all processes of a check share
one clock); durations and limits are plain seconds.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

from tutor.ros_model import Graph, QoS


class Level(IntEnum):
    """Severity of a log message, as `rcl_interfaces/msg/Log` numbers it."""

    DEBUG = 10
    INFO = 20
    WARN = 30
    ERROR = 40
    FATAL = 50


@dataclass(frozen=True, slots=True)
class Sample:
    """One message on a topic. `message` maps each field to its value (nested messages are mappings too)."""

    topic: str
    message: Mapping[str, Any]
    source_time: float
    received_at: float


@dataclass(frozen=True, slots=True)
class LogRecord:
    """One message on `/rosout`. `level` is a severity number (see `Level`); `function`: the function that logged it."""

    level: int
    name: str
    text: str
    stamp: float
    received_at: float
    function: str = ""

    def __str__(self) -> str:
        label = Level(self.level).name if self.level in set(Level) else str(self.level)
        return f"[{label}] [{self.name}]: {self.text}"


@dataclass(frozen=True, slots=True)
class Exit:
    """How a process ended. Exactly one of `code` and `signal` is set. `after_s`: seconds since it was started."""

    code: int | None
    signal: int | None
    after_s: float

    def __str__(self) -> str:
        return f"exit code {self.code}" if self.code is not None else f"signal {self.signal}"


@dataclass(frozen=True, slots=True)
class OutputLine:
    """One line of output. `stream` is "stdout" or "stderr"; a long line is truncated."""

    stream: str
    text: str
    at: float


@dataclass(frozen=True, slots=True)
class Ending:
    """What happened after one SIGINT (as sent by Ctrl+C).

    `exit` is None if the process was still running after `limit_s` seconds; `output` is what it wrote since the SIGINT.
    `survivors` holds the command lines of the processes that remained at the end (including its own).
    `cpu_wait_share`: how long the processes had waited for a CPU by then, as a share of the time since their start.
    """

    exit: Exit | None
    took_s: float
    limit_s: float
    output: tuple[OutputLine, ...] = ()
    survivors: tuple[str, ...] = ()
    cpu_wait_share: float = 0.0


@dataclass(frozen=True, slots=True)
class SetAnswer:
    """The answer to setting parameters: one (successful, reason) pair, or `answered` False if none came in time."""

    values: Mapping[str, Any]
    answered: bool
    successful: bool
    reason: str
    asked_at: float
    answered_at: float

    @property
    def took_s(self) -> float:
        """Seconds from the request to the answer, or to giving up."""
        return self.answered_at - self.asked_at


@dataclass(frozen=True, slots=True)
class CallAnswer:
    """The answer to one service call. `response` is None if none came in time, or none could come any more."""

    service: str
    request: Mapping[str, Any]
    response: Mapping[str, Any] | None
    asked_at: float
    answered_at: float

    @property
    def took_s(self) -> float:
        """Seconds from the request to the answer, or to giving up."""
        return self.answered_at - self.asked_at


@dataclass(frozen=True, slots=True)
class ServedRequest:
    """One request that our own service server answered."""

    service: str
    request: Mapping[str, Any]
    response: Mapping[str, Any]
    at: float


@dataclass(frozen=True, slots=True)
class HeldRequest:
    """A request that a service server of ours has taken, and replies to when it is told to. `number`: counts from 0."""

    number: int
    request: Mapping[str, Any]
    at: float


@dataclass(frozen=True, slots=True)
class GoalAnswer:
    """What has become of a goal that we sent to an action server.

    `accepted` and `cancel_accepted` are None without an answer. `outcome`: how the goal ended ("succeeded", "canceled",
    "aborted", or "unknown" to the server), or "" as long as it has not; then there is a `result`.
    """

    accepted: bool | None = None
    feedback: tuple[Sample, ...] = ()
    cancel_accepted: bool | None = None
    outcome: str = ""
    result: Mapping[str, Any] | None = None


@dataclass(frozen=True, slots=True)
class ServedGoal:
    """A goal that our own action server got.

    `at`: when it came in. `feedback`: how many messages it has sent so far. `ended`: the result is there.
    """

    goal: Mapping[str, Any]
    accepted: bool
    at: float = 0.0
    feedback: int = 0
    ended: bool = False


@dataclass(frozen=True, slots=True)
class Echo:
    """What `ros2 topic echo` would have shown. `types`: all types on the topic; with more than one, echo refuses.

    `limit_s`: how long it looked, in seconds.
    """

    topic: str
    types: tuple[str, ...]
    qos: QoS
    samples: tuple[Sample, ...]
    limit_s: float


@dataclass(frozen=True, slots=True)
class Trace:
    """Everything observed in one run of the learner's process.

    `folder`: the folder of the learner's file. `output` is bounded: `dropped_lines` counts the lines dropped from its
    middle. `unbuilt`: the interface packages beside the file that could not be built, and why, in a sentence each.

    Three fields come from the source, and only shape the wording of a diagnosis, never a verdict (see
    `tutor.source`). `uncalled_main`: the file defines `main` but never calls it. `launch_arguments`: the names of
    the launch arguments that it declares. `sources`: by file name, the text of the file and of its local imports.
    """

    file: str
    folder: str = ""
    uncalled_main: bool = False
    launch_arguments: tuple[str, ...] = ()
    sources: Mapping[str, str] = field(default_factory=dict)
    parameters: Mapping[str, Any] = field(default_factory=dict)
    started_at: float = 0.0
    samples: Mapping[str, tuple[Sample, ...]] = field(default_factory=dict)
    logs: tuple[LogRecord, ...] = ()
    graph: Graph = field(default_factory=Graph)
    output: tuple[OutputLine, ...] = ()
    dropped_lines: int = 0
    exit: Exit | None = None
    unbuilt: Mapping[str, str] = field(default_factory=dict)

    def samples_on(self, topic: str) -> tuple[Sample, ...]:
        """The samples of one topic, oldest first."""
        return self.samples.get(topic, ())
