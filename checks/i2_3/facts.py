"""I2.3: what the node must do, and the facts gathered about it."""

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
"""Accepted range for 3 s: thirty sleeps of 0.1 s may take 2.9 s or 3.2 s, but 2.5 s or 3.5 s are meant to differ."""

EXCUSED_S = 0.5
"""Maximum delay of a call that is attributed to a busy machine."""

STARVED_SHARE = 0.9
"""CPU wait, as a share of a call, from which on nothing is known of the call. Checks five at a time stay below it."""

NEGLIGIBLE_S = 0.2
"""CPU wait, in seconds, that is too short to cast doubt on an observation."""

MAX_EXCUSED_PAUSE_S = 1.0
"""A timer may pause this much longer on a busy machine. With more, one that is blocked for 3 s would pass."""

ANSWER_TIMEOUT_S = 8.0
"""Timeout of a call: a service that answers later than 3 s, but within this time, is reported as too slow.

A request that is lost at first is resent within 3.5 s, so a correct answer may take 7 s.
"""

CALLS = 3
PARALLEL_RATIO = 1.5
"""Three concurrent calls that run in parallel take less than this many times one call."""

INCONCLUSIVE_RATIO = 1.2
"""Concurrent calls are inconclusive if, without the CPU wait, they took less than this many times one call."""

SEQUENTIAL_RATIO = 2.6
"""Three calls that take more than this many times one ran one after another, however busy the machine is."""


@dataclass(frozen=True)
class IdleRun:
    """A run without any call: the timer's log messages, and the shutdown of an idle node.

    `series`: the possible readings of the timer's log messages: all those of 10 Hz, else the likeliest one of another
    pace, if any. `excused`: the machine was too busy for the pace to mean anything.
    """

    trace: Trace
    series: tuple[Series, ...] = ()
    excused: bool = False
    ending: Ending | None = None


@dataclass(frozen=True)
class Call:
    """One call, with no other call at the same time.

    `until`: the end of listening to the node after the call (seconds since the epoch); `cpu_wait_s`: how long, during
    the call, the node or our process waited for the CPU.
    """

    answer: CallAnswer
    until: float
    cpu_wait_s: float = 0.0

    @property
    def in_time(self) -> bool:
        """Whether the answer came, and not too late. However busy the machine, a call of 4 s is too slow."""
        limit_s = LONGEST_S + min(self.cpu_wait_s, EXCUSED_S)
        return self.answer.response is not None and self.answer.took_s <= limit_s

    @property
    def nearly_in_time(self) -> bool:
        """Whether the answer was so little late, or the CPU so scarce, that a busy machine may be the reason."""
        starved = self.cpu_wait_s >= STARVED_SHARE * self.answer.took_s
        return self.answer.response is not None and (starved or self.answer.took_s <= LONGEST_S + 2 * EXCUSED_S)

    @property
    def busy(self) -> bool:
        """Whether the machine was busy enough during the call to have made the answer late."""
        return self.cpu_wait_s >= CPU_WAIT_SHARE * self.answer.took_s


@dataclass(frozen=True)
class SingleCalls:
    """Single calls with large numbers: one, or more if the first was disturbed; none if there was no service.

    `later`: the second call and its repetitions; only made if nothing was wrong with the first.
    `stuck`: the stack dump of the node's threads during a call (innermost frames first), taken if the call was not
    answered or the timer paused; `spins`: whether the node answered any request then. `idle`: the run without calls,
    if the first call is reported before the scenario has ended.
    """

    trace: Trace
    calls: tuple[Call, ...] = ()
    stuck: tuple[Frame, ...] = ()
    spins: bool = True
    later: tuple[Call, ...] = ()
    idle: IdleRun | None = None

    @property
    def first_and_later(self) -> tuple[SingleCalls, ...]:
        """The first call and the second one, each with its repetitions, to be judged separately."""
        first = replace(self, later=())
        return (first, replace(first, calls=self.later)) if self.later else (first,)

    @property
    def quickest(self) -> Call | None:
        """The answered call that took the least time, and so was delayed least by the machine."""
        answered = [call for call in self.calls if call.answer.response is not None]
        return min(answered, key=lambda call: call.answer.took_s, default=None)


@dataclass(frozen=True)
class CallBatch:
    """Three concurrent calls. `cpu_wait_s`: how long, during them, the node or our process waited for the CPU."""

    answers: tuple[CallAnswer, ...]
    cpu_wait_s: float = 0.0

    @property
    def correct_count(self) -> int:
        """The number of calls answered with their own sum."""
        return sum(each.response is not None and each.response["sum"] == right_sum(each) for each in self.answers)

    @property
    def took_s(self) -> float:
        """Seconds from the first request to the last answer."""
        return max(a.answered_at for a in self.answers) - min(a.asked_at for a in self.answers)

    def may_be_slowed(self, one_s: float) -> bool:
        """Whether a busy machine may be the only reason that they took longer than one call of `one_s` seconds."""
        return self.took_s < SEQUENTIAL_RATIO * one_s and self.took_s - self.cpu_wait_s < INCONCLUSIVE_RATIO * one_s


@dataclass(frozen=True)
class ConcurrentCalls:
    """Batches of three concurrent calls: several if the machine may have delayed them, none if there was no service."""

    trace: Trace
    batches: tuple[CallBatch, ...] = ()

    def is_conclusive(self, one_s: float) -> bool:
        """Whether the batches show how the node serves concurrent calls, however busy the machine was.

        The first batch is left out if there are others: connecting may have delayed it.
        """
        return not all(batch.may_be_slowed(one_s) for batch in self.batches[1:] or self.batches)


@dataclass(frozen=True)
class Interrupted:
    """A run with Ctrl+C during a call. `called`: whether there was a service to call.

    `slowed`: the node ended during the call, but not before Ctrl+C was due: a busy machine has delayed that.
    """

    trace: Trace
    called: bool
    ending: Ending | None = None
    slowed: bool = False


def has_service(services: Sequence[ServiceEndpoint]) -> bool:
    """Whether the service exists, with the right type."""
    return any(service.name == SERVICE and service.type == TYPE for service in services)


def right_sum(answer: CallAnswer) -> int:
    """The sum that the service must answer with."""
    return int(answer.request["a"]) + int(answer.request["b"])


def is_disturbed(logs: Sequence[LogRecord], call: Call, series: Sequence[Series]) -> bool:
    """Whether the timer's messages lose their pace during this call in every possible reading of them."""
    right = [each for each in series if each.is_10_hz]
    return bool(right) and all(timer_during_call(each, logs, call).fault for each in right)


def is_doubtful(logs: Sequence[LogRecord], call: Call, series: Sequence[Series]) -> bool:
    """Whether the timer only counts as undisturbed during this call because the machine was busy."""
    if call.cpu_wait_s <= NEGLIGIBLE_S or is_disturbed(logs, call, series):
        return False
    return is_disturbed(logs, replace(call, cpu_wait_s=NEGLIGIBLE_S), series)


def stops_timer(logs: Sequence[LogRecord], call: Call, series: Sequence[Series]) -> bool:
    """Whether no timer logs anything during this call, although two messages are due even without the CPU wait."""
    begin, end = call.answer.asked_at + NEGLIGIBLE_S, call.answer.answered_at - NEGLIGIBLE_S
    if not series or 2 * max(each.longest_s for each in series) > end - begin - call.cpu_wait_s:
        return False
    return not any(begin <= log.stamp <= end and each.key.of(log) for log in logs for each in series)


def is_excused(logs: Sequence[LogRecord], call: Call, series: Sequence[Series]) -> bool:
    """Whether a busy machine may have disturbed the timer: its pace is acceptable with twice the CPU wait."""
    right = [each for each in series if each.is_10_hz]
    return call.busy and any(_timer_during_call(each, logs, call, 2 * call.cpu_wait_s).fault is None for each in right)


def timer_during_call(series: Series, logs: Sequence[LogRecord], call: Call) -> TimerPace:
    """The timer's pace during this call."""
    return _timer_during_call(series, logs, call, min(call.cpu_wait_s, MAX_EXCUSED_PAUSE_S))


def _timer_during_call(series: Series, logs: Sequence[LogRecord], call: Call, cpu_wait_s: float) -> TimerPace:
    asked, answered = call.answer.asked_at, call.answer.answered_at
    return measure_timer(series, logs, asked, answered, until=call.until, cpu_wait_s=cpu_wait_s)
