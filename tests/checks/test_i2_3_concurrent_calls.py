"""I2.3: verdicts on fabricated service calls, three at once, and on how the node then ends."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from checks.i2_3_multi_threaded_service import CHECK
from checks.i2_3_multi_threaded_service.call_scenarios import ConcurrentCalls, Interrupted
from checks.i2_3_multi_threaded_service.calls import MAX_AT_ONCE_TRIES, needs_repeat_at_once
from checks.i2_3_multi_threaded_service.idle_run import IdleRun
from checks.i2_3_multi_threaded_service.judges import (
    judge_concurrent,
    judge_concurrent_so_far,
    judge_parallel,
    judge_shutdown_busy,
)
from checks.i2_3_multi_threaded_service.single_calls import SingleCalls
from tests.checks.builders import (
    CRASHED,
    KEYBOARD_INTERRUPT,
    NODE_UP,
    assert_passed,
    assert_skipped,
    ending,
    judge_of,
    trace,
)
from tests.checks.slow_add import (
    SERVING,
    SUMS,
    WAITING,
    answer,
    assert_failed,
    assert_told,
    concurrent,
    idle_run,
    single_calls,
)
from tutor.judge.verdict import Status

judge_shutdown = judge_of(CHECK, "shutdown")


@pytest.mark.parametrize(
    ("seen", "told", "words"),
    [
        (concurrent(*SUMS), "passed", ""),
        (concurrent(*SUMS, took_s=(9.0, 3.0, 6.0)), "passed", ""),
        (concurrent(3005, 3005, 3005), "shared state", "1 of 3"),
        (concurrent(3005, 3005, 3005, cpu_wait_s=9.0), "shared state", ""),
        (concurrent(1005, -1, -1), "wrong answer", "-1"),
        (concurrent(1005, None, None), "no answer", "2 of 3"),
        (ConcurrentCalls(CRASHED, concurrent(1005, None, None).batches), "unhandled exception", ""),
        (concurrent(None, None, None, took_s=(8.0, 8.0, 8.0), cpu_wait_s=4.0), "no answer", ""),
        (concurrent(None, None, None, took_s=(8.0, 8.0, 8.0), cpu_wait_s=9.0), "undecided", ""),  # a starved machine
    ],
)
def test_three_concurrent_calls(seen: ConcurrentCalls, told: str, words: str) -> None:
    assert_told(judge_concurrent(seen), told, words)


def test_concurrent_calls_are_not_judged_without_the_service() -> None:
    assert_skipped(judge_concurrent(ConcurrentCalls(trace(graph=NODE_UP))), "")


def test_three_unanswered_calls_are_judged_only_with_the_single_calls() -> None:
    assert_failed(judge_concurrent_so_far(concurrent(3005, 3005, 3005)), "shared state")
    assert_passed(judge_concurrent_so_far(concurrent(*SUMS)))
    assert judge_concurrent_so_far(concurrent(None, None, None)) is None


@given(st.permutations(SUMS))
def test_each_concurrent_call_gets_its_own_sum(sums: list[int]) -> None:
    right = sums == [*SUMS]
    assert judge_concurrent(concurrent(*sums)).status is (Status.PASSED if right else Status.FAILED)


def in_batches(*batches: ConcurrentCalls) -> ConcurrentCalls:
    return ConcurrentCalls(trace(graph=SERVING), tuple(batch for made in batches for batch in made.batches))


def two_at_a_time(cpu_wait_s: float) -> ConcurrentCalls:
    return concurrent(*SUMS, took_s=(3.0, 3.0, 6.0), cpu_wait_s=cpu_wait_s)


CALM, BUSY = two_at_a_time(0.3), two_at_a_time(3.0)


@pytest.mark.parametrize(
    ("seen", "told", "words"),
    [
        (concurrent(*SUMS, took_s=(3.0, 3.1, 4.4)), "passed", ""),
        (concurrent(*SUMS, took_s=(3.0, 3.1, 4.9), cpu_wait_s=0.6), "passed", ""),
        (in_batches(concurrent(*SUMS, took_s=(3.0, 3.1, 5.0)), concurrent(*SUMS)), "passed", ""),
        (two_at_a_time(0.0), WAITING, "some of three calls"),
        (two_at_a_time(2.6), "undecided", ""),
        (concurrent(*SUMS, took_s=(3.0, 6.0, 9.0), cpu_wait_s=5.0), WAITING, "all of three calls"),
        *((in_batches(*made), WAITING, "2.0 times")
          for made in ([CALM], [CALM, CALM], [BUSY, CALM], [BUSY, CALM, BUSY])),
        # The first may have been delayed by discovery.
        *((in_batches(*made), "undecided", "") for made in ([BUSY], [BUSY, BUSY], [CALM, BUSY, BUSY])),
    ],
)  # fmt: skip
def test_parallel(seen: ConcurrentCalls, told: str, words: str) -> None:
    assert_told(judge_parallel(single_calls(), seen), told, words)


@pytest.mark.parametrize(
    ("cpu_wait_s", "times"),
    [
        ((0.0, 0.0), 2),
        ((3.0, 0.0), 2),
        ((0.3, 0.3, 0.3), 3),
        ((3.0, 3.0, 0.3), 3),
        ((3.0, 3.0, 3.0, 0.3), 4),
        ((0.3, 3.0, 3.0, 3.0, 0.3), 5),
        ((3.0,) * 6, MAX_AT_ONCE_TRIES),
    ],
)
def test_concurrent_calls_are_repeated_until_conclusive(cpu_wait_s: Sequence[float], times: int) -> None:
    made = in_batches(*map(two_at_a_time, cpu_wait_s)).batches
    repeated = [needs_repeat_at_once(made[:n]) for n in range(1, len(made) + 1)]
    assert repeated == [True] * (times - 1) + [False]


@pytest.mark.parametrize(
    "conclusive",
    [
        concurrent(*SUMS, cpu_wait_s=3.0),
        concurrent(*SUMS, took_s=(3, 6, 9), cpu_wait_s=3.0),
        concurrent(1005, None, 3005, took_s=(3.0, 3.0, 6.0), cpu_wait_s=3.0),
    ],
    ids=["all at once", "one after the other", "one lost"],
)
def test_concurrent_calls_that_leave_no_doubt_are_not_repeated(conclusive: ConcurrentCalls) -> None:
    assert not needs_repeat_at_once(conclusive.batches)


def test_shutdown() -> None:
    assert_passed(judge_shutdown(idle_run([], ending=ending())))
    assert_failed(judge_shutdown(idle_run([], ending=ending(1, err=KEYBOARD_INTERRUPT))), "traceback on exit")


def test_shutdown_busy() -> None:
    clean = Interrupted(trace(graph=SERVING), True, ending(130))
    assert_passed(judge_shutdown_busy(clean, single_calls()))
    stays = Interrupted(trace(graph=SERVING), True, ending(still_running=True))
    assert_failed(judge_shutdown_busy(stays, single_calls()), "does not end")
    assert_skipped(judge_shutdown_busy(Interrupted(CRASHED, False), SingleCalls(trace())), "`blocks` shows why")
    assert_skipped(judge_shutdown(IdleRun(CRASHED)), "`blocks` shows why")
    gone = Interrupted(trace(graph=NODE_UP), False, ending())
    assert_skipped(judge_shutdown_busy(gone, SingleCalls(trace())), "")
    unanswered = single_calls([], answer(sum_=None))
    assert_skipped(judge_shutdown_busy(clean, unanswered), "")
    assert_failed(judge_shutdown_busy(stays, unanswered), "does not end")
