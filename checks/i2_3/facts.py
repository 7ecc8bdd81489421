"""I2.3: what is asked of the node, and the facts that are gathered."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from checks.i2_3.pace import TimerPace, measure_timer
from checks.i2_3.ticks import Series
from tutor.judge.trace import CallAnswer, Ending, LogRecord, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting import CPU_WAIT_SHARE
from tutor.ros_model import ServiceEndpoint

FILE = "concurrent_service.py"
SERVICE, TYPE = "/slow_add", "example_interfaces/srv/AddTwoInts"

WORK_S = 3.0
SHORTEST_S, LONGEST_S = 2.75, 3.4
"""What counts as 3 s: thirty waits of 0.1 s may be 2.9 s or 3.2 s; neither 2.5 s nor 3.5 s is meant."""

EXCUSED_S = 0.5
"""A busy machine may add this much to what a call takes."""

NEGLIGIBLE_S = 0.2
"""Seconds that a busy machine takes away without anybody being in doubt about the rest."""

MOST_EXCUSED_S = 1.0
"""A timer may pause this much longer on a busy machine. With more, one that stands still for 3 s looks like another."""

ANSWER_S = 12.0
"""A service that answers after some other time than 3 s gets that as its cause, up to this one."""

CALLS = 3
PARALLEL = 1.5
"""Three calls at once take less than this many times one call where they run in parallel."""

SLOWED_AT_MOST = 1.2
"""Calls that took more only because the machine was busy, and less than this many times one without, tell nothing."""

IN_TURN = 2.6
"""Three calls that take more than this many times one were made one after another, however busy the machine is."""


@dataclass(frozen=True)
class IdleRun:
    """A start without any call: what the timer logs by itself, and how Ctrl+C ends an idle node.

    `series` are the ways to see the timer's log messages: all those of 10 Hz, or the likeliest of another pace, or
    none. `excused`: the pace means nothing, the machine was too busy.
    """

    trace: Trace
    series: tuple[Series, ...] = ()
    excused: bool = False
    ending: Ending | None = None


@dataclass(frozen=True)
class Call:
    """One call, made while no other was.

    `until`: how long the node was listened to after it (seconds since the epoch); `cpu_wait_s`: seconds of the call in
    which the machine kept the node, or us, who wait for its answer, from running.
    """

    answer: CallAnswer
    until: float
    cpu_wait_s: float = 0.0

    @property
    def in_time(self) -> bool:
        """Whether it was answered, and not too late. No machine is so busy that 4 s become 3 s."""
        limit_s = LONGEST_S + min(self.cpu_wait_s, EXCUSED_S)
        return self.answer.response is not None and self.answer.took_s <= limit_s

    @property
    def near(self) -> bool:
        """Whether it was answered almost in time, so that a busy machine may be what made it late."""
        return self.answer.response is not None and self.answer.took_s <= LONGEST_S + 2 * EXCUSED_S

    @property
    def busy(self) -> bool:
        """Whether the machine was so busy meanwhile that what was late may have been on time."""
        return self.cpu_wait_s >= CPU_WAIT_SHARE * self.answer.took_s


@dataclass(frozen=True)
class SingleCalls:
    """Single calls: one, or more where the first was disturbed; none where the service was not there.

    `later` are those made for a second time, with large numbers, where nothing was wrong with the first. `stuck`: where
    the node's threads are during a call (innermost frames first), looked up where the call was not answered or the
    timer stood still; `spins`: whether the node answered anything at all then. `idle`: what the timer does without a
    call, where the first call and its repetitions are told of before all is over.
    """

    trace: Trace
    calls: tuple[Call, ...] = ()
    stuck: tuple[Frame, ...] = ()
    spins: bool = True
    later: tuple[Call, ...] = ()
    idle: IdleRun | None = None

    @property
    def first_and_later(self) -> tuple[SingleCalls, ...]:
        """The first call and the second one, each with its repetitions, to be judged for itself."""
        first = replace(self, later=())
        return (first, replace(first, calls=self.later)) if self.later else (first,)

    @property
    def quickest(self) -> Call | None:
        """The answered call that took the least time: whatever the machine adds, it is the nearest to the truth."""
        answered = [call for call in self.calls if call.answer.response is not None]
        return min(answered, key=lambda call: call.answer.took_s, default=None)


@dataclass(frozen=True)
class CallBatch:
    """Three calls made at once, and the seconds in which the machine kept the node, or us, from running meanwhile."""

    answers: tuple[CallAnswer, ...]
    cpu_wait_s: float = 0.0

    @property
    def right(self) -> int:
        """How many were answered with their own sum."""
        return sum(each.response is not None and each.response["sum"] == right_sum(each) for each in self.answers)

    @property
    def took_s(self) -> float:
        """Seconds from the first request to the last answer."""
        return max(a.answered_at for a in self.answers) - min(a.asked_at for a in self.answers)

    def may_be_slowed(self, one_s: float) -> bool:
        """Whether a busy machine alone may be why they took longer than one call, which takes `one_s` seconds."""
        return self.took_s < IN_TURN * one_s and self.took_s - self.cpu_wait_s < SLOWED_AT_MOST * one_s


@dataclass(frozen=True)
class ConcurrentCalls:
    """Three calls at once, made again where the machine may have held them up; not made where there was no service."""

    trace: Trace
    batches: tuple[CallBatch, ...] = ()

    def is_conclusive(self, one_s: float) -> bool:
        """Whether they show how the node serves calls at once, however busy the machine was.

        What held up the first time only may have been the first connection.
        """
        return not all(three.may_be_slowed(one_s) for three in self.batches[1:] or self.batches)


@dataclass(frozen=True)
class Interrupted:
    """Ctrl+C during a call. `called`: whether there was a service to call."""

    trace: Trace
    called: bool
    ending: Ending | None = None


def has_service(services: Sequence[ServiceEndpoint]) -> bool:
    """Whether the service is there, with its type."""
    return any(service.name == SERVICE and service.type == TYPE for service in services)


def right_sum(answer: CallAnswer) -> int:
    """What the service must answer."""
    return int(answer.request["a"]) + int(answer.request["b"])


def is_disturbed(logs: Sequence[LogRecord], call: Call, series: Sequence[Series]) -> bool:
    """Whether no way to see the timer's messages lets them go on as they should during this call."""
    right = [each for each in series if each.is_10_hz]
    return bool(right) and all(timer_during_call(each, logs, call).fault for each in right)


def is_doubtful(logs: Sequence[LogRecord], call: Call, series: Sequence[Series]) -> bool:
    """Whether the timer seems undisturbed during this call only because a busy machine excuses much."""
    if call.cpu_wait_s <= NEGLIGIBLE_S or is_disturbed(logs, call, series):
        return False
    return is_disturbed(logs, replace(call, cpu_wait_s=NEGLIGIBLE_S), series)


def is_excused(logs: Sequence[LogRecord], call: Call, series: Sequence[Series]) -> bool:
    """Whether a busy machine may be what disturbed the timer: had it lost twice the time, all would be well."""
    right = [each for each in series if each.is_10_hz]
    return call.busy and any(_timer_during_call(each, logs, call, 2 * call.cpu_wait_s).fault is None for each in right)


def timer_during_call(series: Series, logs: Sequence[LogRecord], call: Call) -> TimerPace:
    """What was seen of the timer during this call."""
    return _timer_during_call(series, logs, call, min(call.cpu_wait_s, MOST_EXCUSED_S))


def _timer_during_call(series: Series, logs: Sequence[LogRecord], call: Call, cpu_wait_s: float) -> TimerPace:
    asked, answered = call.answer.asked_at, call.answer.answered_at
    return measure_timer(series, logs, asked, answered, until=call.until, cpu_wait_s=cpu_wait_s)
