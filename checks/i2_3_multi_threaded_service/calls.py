"""I2.3: calls of the service, one at a time and three at once, and the pace that the timer keeps meanwhile."""

from __future__ import annotations

from dataclasses import dataclass

from tutor.exercise import Program, Service
from tutor.exercise.service_calls import Server, right_result
from tutor.judge.trace import CallAnswer
from tutor.judge.waiting import CPU_WAIT_SHARE

SLOW_ADD = Service("/slow_add", "example_interfaces/srv/AddTwoInts", ("a", "b"), "sum", lambda a, b: a + b, "+")
PROGRAM = Program("concurrent_service.py")
SERVER = Server(PROGRAM, (SLOW_ADD,))

WORK_S = 3.0
SHORTEST_S, LONGEST_S = 2.75, 3.4
"""Accepted range for 3 s: thirty sleeps of 0.1 s may take 2.9 s or 3.2 s, but 2.5 s or 3.5 s are meant to differ."""

EXCUSED_S = 0.5
"""Maximum delay of a call that is attributed to a busy machine."""

BUSY_S = 0.1
"""A CPU wait shorter than this does not disturb a call."""

STARVED_SHARE = 0.9
"""CPU wait, as a share of a call, from which on nothing is known of the call. Checks five at a time stay below it."""

CALLS = 3
PARALLEL_RATIO = 1.5
"""Three concurrent calls that run in parallel take less than this many times one call."""

INCONCLUSIVE_RATIO = 1.2
"""Concurrent calls are inconclusive if, without the CPU wait, they took less than this many times one call."""

SEQUENTIAL_RATIO = 2.6
"""Three calls that take more than this many times one ran one after another, however busy the machine is."""

AT_ONCE_TRIES, MAX_AT_ONCE_TRIES = 3, 6
"""How often three concurrent calls are made that a busy machine may have disturbed: at most `MAX_AT_ONCE_TRIES` times
if none of them was conclusive."""


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
        return self.answered and self.answer.took_s <= LONGEST_S + min(self.cpu_wait_s, EXCUSED_S)

    @property
    def nearly_in_time(self) -> bool:
        """Whether the answer was so little late, or the CPU so scarce, that a busy machine may be the reason."""
        starved = self.cpu_wait_s >= STARVED_SHARE * self.answer.took_s
        return self.answered and (starved or self.answer.took_s <= LONGEST_S + 2 * EXCUSED_S)

    @property
    def busy(self) -> bool:
        """Whether the machine was busy enough during the call to have made the answer late."""
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

    def may_be_slowed(self, one_s: float) -> bool:
        """Whether a busy machine may be the only reason that they took longer than one call of `one_s` seconds."""
        return self.took_s < SEQUENTIAL_RATIO * one_s and self.took_s - self.cpu_wait_s < INCONCLUSIVE_RATIO * one_s


def is_conclusive(batches: tuple[CallBatch, ...], one_s: float) -> bool:
    """Whether the batches show how the node serves concurrent calls, however busy the machine was.

    The first batch is left out if there are others: connecting may have delayed it.
    """
    return not all(batch.may_be_slowed(one_s) for batch in batches[1:] or batches)


def needs_repeat_at_once(batches: tuple[CallBatch, ...]) -> bool:
    """Whether to call three times again: it took longer than parallel calls do, but less than sequential ones."""
    last, tried = batches[-1], len(batches)
    one_s = min(answer.took_s for answer in last.answers)
    partly_parallel = 1.4 < last.took_s / one_s < SEQUENTIAL_RATIO
    if last.correct_count < CALLS or not partly_parallel or (tried > 1 and last.cpu_wait_s <= BUSY_S):
        return False
    return tried < AT_ONCE_TRIES or (tried < MAX_AT_ONCE_TRIES and not is_conclusive(batches, one_s))
