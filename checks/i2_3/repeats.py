"""I2.3: when to repeat a call that the machine may have disturbed."""

from __future__ import annotations

from collections.abc import Sequence

from checks.i2_3.facts import (
    CALLS,
    LONGEST_S,
    SEQUENTIAL_RATIO,
    Call,
    CallBatch,
    ConcurrentCalls,
    is_disturbed,
    is_doubtful,
    is_excused,
    stops_timer,
)
from checks.i2_3.ticks import Series
from tutor.judge.trace import LogRecord

BUSY_S = 0.1
"""A CPU wait shorter than this does not disturb a call."""

TRIES, MAX_TRIES = 4, 8
"""How often a call is made that a busy machine may have disturbed: at most `TRIES` times, or `MAX_TRIES` if none of
them was conclusive. A machine is seldom so busy for half a minute.
"""

AT_ONCE_TRIES, MAX_AT_ONCE_TRIES = 3, 6
"""The same for three concurrent calls."""


def needs_repeat(logs: Sequence[LogRecord], calls: Sequence[Call], series: Sequence[Series], max_tries: int) -> bool:
    """Whether to call again, to tell effects of the machine, or of the first connection, from the node's own behaviour.

    A timer that stops for the whole call is the node's. More than `TRIES` calls, up to `max_tries`, are only made if
    none so far was conclusive.
    """
    call, tried = calls[-1], len(calls)
    if call.answer.response is None:
        return False
    disturbed, late = is_disturbed(logs, call, series), call.answer.took_s > LONGEST_S
    if tried == 1:
        stopped = disturbed and not late and stops_timer(logs, call, series)
        return not stopped and (disturbed or late or is_doubtful(logs, call, series))
    excused = disturbed and is_excused(logs, call, series)
    if tried < TRIES:
        return excused or (late and call.nearly_in_time and call.cpu_wait_s > BUSY_S) or is_doubtful(logs, call, series)
    return tried < max_tries and (excused or (late and call.nearly_in_time and all(each.busy for each in calls)))


def needs_repeat_at_once(seen: ConcurrentCalls) -> bool:
    """The same for concurrent calls."""
    last, tried = seen.batches[-1], len(seen.batches)
    one_s = min(answer.took_s for answer in last.answers)
    if last.correct_count < CALLS or not _is_partly_parallel(last, one_s) or (tried > 1 and last.cpu_wait_s <= BUSY_S):
        return False
    return tried < AT_ONCE_TRIES or (tried < MAX_AT_ONCE_TRIES and not seen.is_conclusive(one_s))


def _is_partly_parallel(batch: CallBatch, one_s: float) -> bool:
    """Whether the batch took longer than parallel calls do, but less than sequential ones."""
    return 1.4 < batch.took_s / one_s < SEQUENTIAL_RATIO
