"""I2.3: what is asked of the node, and the facts that are gathered."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from checks.i2_3.ticks import Series
from tutor.judge.trace import CallAnswer, Ending, Service, Trace
from tutor.judge.tracebacks import Frame

FILE = "concurrent_service.py"
SERVICE, TYPE = "/slow_add", "example_interfaces/srv/AddTwoInts"

WORK_S = 3.0
SHORTEST_S, LONGEST_S = 2.75, 3.4
"""What counts as 3 s: thirty waits of 0.1 s may be 2.9 s or 3.2 s; neither 2.5 s nor 3.5 s is meant."""

ANSWER_S = 12.0
"""A service that answers after some other time than 3 s is told so, up to this one."""

CALLS = 3
PARALLEL = 1.5
"""Three calls at once take less than this many times one call where they run in parallel."""


@dataclass(frozen=True)
class Quiet:
    """A start without any call: what the timer logs by itself, and how Ctrl+C ends an idle node.

    `series` are the ways to see the timer's log messages: all those of 10 Hz, or the likeliest of another pace, or
    none. `excused`: the pace means nothing, the machine was too busy.
    """

    trace: Trace
    series: tuple[Series, ...] = ()
    excused: bool = False
    ending: Ending | None = None


@dataclass(frozen=True)
class Lone:
    """One call. `answer` is None where the service was not there.

    `until`: how long the node was watched after it (seconds since the epoch); `starved_s`: seconds of the call in which
    the machine kept the node from running; `excused`: they were too many to say anything. `stuck`: where the node's
    threads are during a call (innermost frames first), looked up where the call was not answered or the timer stood
    still; `spins`: whether the node answered anything at all then.
    """

    trace: Trace
    answer: CallAnswer | None = None
    until: float = 0.0
    starved_s: float = 0.0
    excused: bool = False
    stuck: tuple[Frame, ...] = ()
    spins: bool = True


@dataclass(frozen=True)
class Trio:
    """Three calls at once; no answers where the service was not there."""

    trace: Trace
    answers: tuple[CallAnswer, ...] = ()
    starved_s: float = 0.0


@dataclass(frozen=True)
class Interrupted:
    """Ctrl+C during a call. `called`: whether there was a service to call."""

    trace: Trace
    called: bool
    ending: Ending | None = None


def is_there(services: Sequence[Service]) -> bool:
    """Whether the service is there, with its type."""
    return any(service.name == SERVICE and service.type == TYPE for service in services)


def right_sum(answer: CallAnswer) -> int:
    """What the service must answer."""
    return int(answer.request["a"]) + int(answer.request["b"])
