"""Facts: what was seen of a learner's process, as plain data.

Times are seconds. `source_time`, `stamp` and `at` are wall-clock times since the epoch (all processes of a check share
one clock); durations and limits are plain seconds.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

from tutor.judge.known_exception import KnownException
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
    """One message on `/rosout`. `level` is a severity number (see `Level`); `function`: where, if given."""

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
    """One line that the process wrote. `stream` is "stdout" or "stderr"; a long line is cut."""

    stream: str
    text: str
    at: float


@dataclass(frozen=True, slots=True)
class Ending:
    """What happened from one SIGINT (as Ctrl+C sends it) on.

    `exit` is None where the process was still there after `limit_s` seconds; `output` is what it wrote from then on.
    `left` holds the command lines of the processes that were still there in the end (its own included).
    """

    exit: Exit | None
    took_s: float
    limit_s: float
    output: tuple[OutputLine, ...] = ()
    left: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class SetAnswer:
    """The answer to setting parameters: one (successful, reason) pair, or `answered` False where none came in time."""

    values: Mapping[str, Any]
    answered: bool
    successful: bool
    reason: str
    asked_at: float
    answered_at: float

    @property
    def took_s(self) -> float:
        """Seconds from the request to the answer, or to when it was given up."""
        return self.answered_at - self.asked_at


@dataclass(frozen=True, slots=True)
class CallAnswer:
    """The answer to one service call. `response` is None where none came within the limit, or ever would."""

    service: str
    request: Mapping[str, Any]
    response: Mapping[str, Any] | None
    asked_at: float
    answered_at: float

    @property
    def took_s(self) -> float:
        """Seconds from the request to the answer, or to when it was given up."""
        return self.answered_at - self.asked_at


@dataclass(frozen=True, slots=True)
class ServedRequest:
    """One request that our server answered."""

    service: str
    request: Mapping[str, Any]
    response: Mapping[str, Any]
    at: float


@dataclass(frozen=True, slots=True)
class Echo:
    """What `ros2 topic echo` would have shown. `types` are all types on the topic; with more than one, echo refuses."""

    topic: str
    types: tuple[str, ...]
    qos: QoS
    samples: tuple[Sample, ...]
    limit_s: float


@dataclass(frozen=True, slots=True)
class Trace:
    """Everything that was seen of one start of the learner's process.

    `folder` is where the learner's file lies. `output` is bounded: `dropped_lines` says how many lines in its middle
    were not kept. `uncalled_main`: the file defines `main` and calls it nowhere; `launch_arguments`: the names
    that it declares as launch arguments; `sources`: the text of the file, and of those beside it that it imports, by
    file name (all three for the words of a diagnosis, never for a verdict: see `tutor.judge.source`).
    `exceptions`: known ones of the check's own.
    """

    file: str
    folder: str = ""
    uncalled_main: bool = False
    launch_arguments: tuple[str, ...] = ()
    sources: Mapping[str, str] = field(default_factory=dict)
    exceptions: tuple[KnownException, ...] = ()
    parameters: Mapping[str, Any] = field(default_factory=dict)
    started_at: float = 0.0
    samples: Mapping[str, tuple[Sample, ...]] = field(default_factory=dict)
    logs: tuple[LogRecord, ...] = ()
    graph: Graph = field(default_factory=Graph)
    output: tuple[OutputLine, ...] = ()
    dropped_lines: int = 0
    exit: Exit | None = None

    def samples_on(self, topic: str) -> tuple[Sample, ...]:
        """The samples of one topic, oldest first."""
        return self.samples.get(topic, ())
