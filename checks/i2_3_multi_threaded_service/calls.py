"""I2.3: calls of the service, one at a time and three at once, and the pace that the timer keeps meanwhile."""

from __future__ import annotations

from dataclasses import dataclass

from tutor.exercise import Program, Service
from tutor.exercise.service_calls import Server, right_result
from tutor.judge.trace import CallAnswer
from tutor.judge.waiting_for_nodes import CPU_WAIT_SHARE

SLOW_ADD = Service("/slow_add", "example_interfaces/srv/AddTwoInts", ("a", "b"), "sum", lambda a, b: a + b, "+")
PROGRAM = Program("concurrent_service.py")
SERVER = Server(PROGRAM, (SLOW_ADD,))

WORK_S = 3.0
SHORTEST_S, LONGEST_S = 2.75, 3.4
"""Accepted range for 3 s: thirty sleeps of 0.1 s may take 2.9 s or 3.2 s, but 2.5 s or 3.5 s are meant to differ."""

ALLOWANCE_S = 0.5
"""Maximum allowance for a late answer."""

HARDLY_WAITED_S = 0.1
"""A CPU wait shorter than this does not slow a call."""

HARDLY_RAN_SHARE = 0.9
"""A node that waited for a CPU for this share of a call hardly ran. Checks five at a time stay below it."""

CALLS = 3
PARALLEL_RATIO = 1.5
"""Three concurrent calls that run in parallel take less than this many times one call."""

ONLY_SLOWED_RATIO = 1.2
"""Concurrent calls may only have been slowed if, without the CPU wait, they took less than this many times one call."""

SEQUENTIAL_RATIO = 2.6
"""Three calls that take more than this many times one ran one after another, however busy the machine is."""

AT_ONCE_TRIES, MAX_AT_ONCE_TRIES = 3, 6
"""How often three concurrent calls are made that the machine may have slowed: at most `MAX_AT_ONCE_TRIES` times if it
may have slowed all of them."""


def right_sum(answer: CallAnswer) -> int:
    """The sum that the service must answer with."""
    return int(right_result(SLOW_ADD, answer.request))


def sum_in(answer: CallAnswer) -> int | None:
    """The sum that a call was answered with; None if it was not answered."""
    return answer.response[SLOW_ADD.response] if answer.response is not None else None


def is_right(answer: CallAnswer) -> bool:
    """Whether a call was answered with its own sum."""
    return sum_in(answer) == right_sum(answer)


def is_wrong(answer: CallAnswer) -> bool:
    """Whether the answer is wrong however busy the machine is: a wrong sum, or one that comes too early."""
    return answer.response is not None and (not is_right(answer) or answer.took_s < SHORTEST_S)


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
    def answered(self) -> bool:
        """Whether the answer came."""
        return self.answer.response is not None

    @property
    def in_time(self) -> bool:
        """Whether the answer came, and not too late. However busy the machine, a call of 4 s is too slow."""
        return self.answered and self.answer.took_s <= LONGEST_S + min(self.cpu_wait_s, ALLOWANCE_S)

    @property
    def nearly_in_time(self) -> bool:
        """Whether the machine may be to blame for a late answer: it was little late, or the node hardly ran."""
        hardly_ran = self.cpu_wait_s >= HARDLY_RAN_SHARE * self.answer.took_s
        return self.answered and (hardly_ran or self.answer.took_s <= LONGEST_S + 2 * ALLOWANCE_S)

    @property
    def slowed(self) -> bool:
        """Whether the wait for a CPU was long enough for the machine to be to blame for a late answer."""
        return self.cpu_wait_s >= CPU_WAIT_SHARE * self.answer.took_s


@dataclass(frozen=True)
class CallBatch:
    """Three concurrent calls. `cpu_wait_s`: how long, during them, the node or our process waited for the CPU."""

    answers: tuple[CallAnswer, ...]
    cpu_wait_s: float = 0.0

    @property
    def correct_count(self) -> int:
        """The number of calls answered with their own sum."""
        return sum(map(is_right, self.answers))

    @property
    def answered(self) -> list[CallAnswer]:
        """The calls that were answered."""
        return [answer for answer in self.answers if answer.response is not None]

    @property
    def took_s(self) -> float:
        """Seconds from the first request to the last answer."""
        return max(a.answered_at for a in self.answers) - min(a.asked_at for a in self.answers)

    def only_slowed(self, one_s: float) -> bool:
        """Whether the machine alone may be to blame if they took longer than one call of `one_s` seconds."""
        return self.took_s < SEQUENTIAL_RATIO * one_s and self.took_s - self.cpu_wait_s < ONLY_SLOWED_RATIO * one_s


def all_only_slowed(batches: tuple[CallBatch, ...], one_s: float) -> bool:
    """Whether no batch shows how the node serves concurrent calls: the machine alone may be to blame for all of them.

    The first batch is left out if there are others: connecting may have delayed it.
    """
    return all(batch.only_slowed(one_s) for batch in batches[1:] or batches)


def needs_repeat_at_once(batches: tuple[CallBatch, ...]) -> bool:
    """Whether to call three times again: it took longer than parallel calls do, but less than sequential ones."""
    last, tried = batches[-1], len(batches)
    one_s = min(answer.took_s for answer in last.answers)
    partly_parallel = 1.4 < last.took_s / one_s < SEQUENTIAL_RATIO
    if last.correct_count < CALLS or not partly_parallel or (tried > 1 and last.cpu_wait_s <= HARDLY_WAITED_S):
        return False
    return tried < AT_ONCE_TRIES or (tried < MAX_AT_ONCE_TRIES and all_only_slowed(batches, one_s))
