"""I2.3: when a call is made once more, because the machine may have disturbed it."""

from __future__ import annotations

from collections.abc import Sequence

from checks.i2_3.facts import (
    CALLS,
    IN_TURN,
    LONGEST_S,
    Call,
    CallBatch,
    ConcurrentCalls,
    is_disturbed,
    is_doubtful,
    is_excused,
)
from checks.i2_3.ticks import Series
from tutor.judge.trace import LogRecord

BUSY_S = 0.1
"""A machine that has kept the node from running for less than this has not disturbed it."""

TRIES, MOST_TRIES = 4, 8
"""A call that a busy machine may have disturbed is made this many times; more where none has shown anything yet.

A machine is seldom so busy for all of half a minute.
"""

AT_ONCE_TRIES, MOST_AT_ONCE_TRIES = 3, 6
"""The same for three calls at once."""


def needs_repeat(logs: Sequence[LogRecord], calls: Sequence[Call], series: Sequence[Series], most: int) -> bool:
    """Whether another call is to tell what the machine, or the first connection, has done from what the node does.

    Of more than `TRIES` calls, up to `most`, only where none of them has shown anything.
    """
    call, tried = calls[-1], len(calls)
    if call.answer.response is None:
        return False
    still, late = is_disturbed(logs, call, series), call.answer.took_s > LONGEST_S
    if tried == 1:
        return still or late or is_doubtful(logs, call, series)
    may_be_ours = still and is_excused(logs, call, series)
    if tried < TRIES:
        return may_be_ours or (late and call.near and call.cpu_wait_s > BUSY_S) or is_doubtful(logs, call, series)
    return tried < most and (may_be_ours or (late and call.near and all(each.busy for each in calls)))


def needs_repeat_at_once(seen: ConcurrentCalls) -> bool:
    """The same for calls made at once."""
    last, tried = seen.batches[-1], len(seen.batches)
    one_s = min(answer.took_s for answer in last.answers)
    if last.right < CALLS or not _late(last, one_s) or (tried > 1 and last.cpu_wait_s <= BUSY_S):
        return False
    return tried < AT_ONCE_TRIES or (tried < MOST_AT_ONCE_TRIES and not seen.is_conclusive(one_s))


def _late(three: CallBatch, one_s: float) -> bool:
    """Whether they took longer than calls that run in parallel do, and less than calls one after another."""
    return 1.4 < three.took_s / one_s < IN_TURN
