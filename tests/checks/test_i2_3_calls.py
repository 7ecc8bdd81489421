"""I2.3: verdicts on fabricated service calls, one by one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from checks.i2_3_multi_threaded_service.call_scenarios import ConcurrentCalls
from checks.i2_3_multi_threaded_service.calls import Call
from checks.i2_3_multi_threaded_service.judges import (
    judge_blocks,
    judge_blocks_so_far,
)
from checks.i2_3_multi_threaded_service.single_calls import SingleCalls
from checks.i2_3_multi_threaded_service.timer_pace import MAX_TRIES, TRIES, Watch
from tests.checks.builders import (
    CRASHED,
    NO_NODE,
    NODE_UP,
    assert_passed,
    assert_undecided,
    graph,
    trace,
)
from tests.checks.slow_add import (
    IN_CALL,
    IN_WORKER,
    SERVICE,
    SUMS,
    TYPE,
    answer,
    assert_failed,
    assert_told,
    concurrent,
    series_in,
    single_calls,
    tick_logs,
)
from tutor.judge.trace import CallAnswer, LogRecord
from tutor.judge.verdict import Verdict


def judge_blocking(seen: SingleCalls, several: ConcurrentCalls | None = None) -> Verdict:
    return judge_blocks(seen, several or ConcurrentCalls(trace()))


@given(st.floats(2.8, 3.35), st.integers(-900, 900), st.integers(-900, 900))
def test_an_answer_after_three_seconds_passes(took_s: float, a: int, b: int) -> None:
    assert_passed(judge_blocking(single_calls((), answer(took_s, a, b, a + b))))


@given(st.floats(0, 2.7) | st.floats(3.5, 12))
def test_other_durations_fail(took_s: float) -> None:
    assert_failed(judge_blocking(single_calls((), answer(took_s))), "wrong duration", "not after 3 s")


@pytest.mark.parametrize(
    ("took_s", "cpu_wait_s", "told", "words"),
    [
        ([3.7], 0.4, "passed", ""),
        ([4.2, 3.3], 0.0, "passed", ""),  # the better of two
        ([4.5, 4.1], 0.0, "wrong duration", "4.1 s"),
        ([2.6], 2.0, "wrong duration", "2.6 s"),  # a busy machine makes no call quick
        ([4.0], 0.6, "wrong duration", "4.0 s"),
        ([4.5], 1.0, "wrong duration", "4.5 s"),
        ([5.7], 1.5, "wrong duration", "5.7 s"),
        ([4.2], 1.0, "undecided", ""),
        ([5.7], 6.1, "undecided", ""),  # a starved machine
    ],
)
def test_a_busy_machine_excuses_slow_answers_but_not_quick_ones(
    took_s: list[float], cpu_wait_s: float, told: str, words: str
) -> None:
    assert_told(judge_blocking(single_calls((), *map(answer, took_s), cpu_wait_s=cpu_wait_s)), told, words)


def test_one_late_call_on_a_calm_machine_is_enough_to_fail() -> None:
    busy, calm = single_calls((), answer(4.05), cpu_wait_s=0.9), single_calls((), answer(4.2), cpu_wait_s=0.3)
    for calls in (busy.calls + calm.calls, calm.calls + busy.calls):
        assert_failed(judge_blocking(replace(busy, calls=calls)), "wrong duration", "4.0 s")
    assert_undecided(judge_blocking(replace(busy, calls=busy.calls * 2)))


def calls_made(call: Call, logs: Sequence[LogRecord] = (), *, most: int = MAX_TRIES, calm_at: int = 99) -> int:
    """The number of calls made, if all are like this one; from number `calm_at` on, the machine is calm."""
    made: list[Call] = []
    while not made or Watch(logs, series_in(tick_logs(every=1))).needs_repeat(made, most):
        made.append(call if len(made) + 1 < calm_at else replace(call, cpu_wait_s=0.0))
    return len(made)


GOOD_CALL, LATE_CALL = Call(answer(), 1004.7, 0.0), Call(answer(4.1), 1004.7, 0.0)
TICKS = tick_logs(every=1, until_s=5.5)


def ticks_but(start_s: float, end_s: float) -> list[LogRecord]:
    return tick_logs(every=1, until_s=5.5, pause=(start_s, end_s))


@pytest.mark.parametrize(
    ("call", "cpu_wait_s", "logs", "how", "times"),
    [
        (GOOD_CALL, 0.0, TICKS, {}, 1),
        (LATE_CALL, 0.0, TICKS, {}, 2),
        (LATE_CALL, 1.0, TICKS, {}, MAX_TRIES),
        (GOOD_CALL, 0.7, ticks_but(0.5, 2), {}, MAX_TRIES),
        (LATE_CALL, 1.0, TICKS, {"most": TRIES}, TRIES),
        (LATE_CALL, 1.0, TICKS, {"calm_at": 3}, 3),
        (LATE_CALL, 1.0, TICKS, {"calm_at": 6}, 6),
        (GOOD_CALL, 0.7, ticks_but(0.5, 2), {"calm_at": 6}, 6),
        (LATE_CALL, 0.3, TICKS, {}, TRIES),  # all of them are conclusive, another might be in time
        (replace(LATE_CALL, answer=answer(5.0)), 1.0, TICKS, {}, 2),
        (replace(LATE_CALL, answer=answer(sum_=None)), 1.0, TICKS, {}, 1),
        # A timer that stops for the whole call needs no repetition unless the machine is busy.
        (GOOD_CALL, 0.0, ticks_but(0.4, 3.3), {}, 1),
        (GOOD_CALL, 0.5, ticks_but(0.4, 3.3), {}, 1),
        (GOOD_CALL, 2.5, ticks_but(0.4, 3.3), {"calm_at": 2}, 2),
        (GOOD_CALL, 0.0, ticks_but(0.4, 2.5), {}, 2),
        (LATE_CALL, 0.0, ticks_but(0.4, 4.4), {}, 2),
    ],
)
def test_calls_are_repeated_until_the_machine_is_not_to_blame(
    call: Call, cpu_wait_s: float, logs: list[LogRecord], how: dict[str, int], times: int
) -> None:
    assert calls_made(replace(call, cpu_wait_s=cpu_wait_s), logs, **how) == times


def test_a_slow_series_shows_no_stop_within_a_call() -> None:
    (call,) = single_calls().calls
    slow = series_in(tick_logs(every=20, until_s=9.0))
    assert not Watch([], slow).is_stopped(call)
    assert Watch([], series_in(tick_logs())).is_stopped(call)
    assert not Watch([], ()).is_stopped(call)


def test_one_wrong_sum_fails() -> None:
    assert_failed(judge_blocking(single_calls((), answer(3.6), answer(3.0, sum_=9))), "wrong answer", "9 instead of 8")


def with_second_call(*called: CallAnswer, cpu_wait_s: float = 0.0) -> SingleCalls:
    """A first call with nothing wrong, and these as the later ones."""
    return replace(single_calls(), later=single_calls((), *called, cpu_wait_s=cpu_wait_s).calls)


@pytest.mark.parametrize(
    ("called", "cause"),
    [(answer(sum_=9), "wrong answer"), (answer(0.01), "wrong duration"), (answer(5.0), "wrong duration")],
)
def test_the_second_call_counts_too(called: CallAnswer, cause: str) -> None:
    assert_passed(judge_blocking(with_second_call(answer())))
    assert_failed(judge_blocking(with_second_call(called)), cause)
    assert judge_blocking(with_second_call(called)).observed.startswith("the second call: ")


def test_what_concurrent_calls_also_show_is_not_reported_twice() -> None:
    for called in (answer(sum_=9), answer(sum_=None)):
        assert_failed(
            judge_blocking(with_second_call(called), concurrent(*SUMS)),
            "wrong answer" if called.response else "no answer",
        )
        assert_passed(judge_blocking(with_second_call(called), concurrent(1005, None, 3005)))


def test_a_second_call_that_a_busy_machine_delayed_leaves_it_open() -> None:
    assert_undecided(judge_blocking(with_second_call(answer(4.2), cpu_wait_s=1.0)))


@pytest.mark.parametrize(
    ("seen", "cause", "word"),
    [
        (single_calls((), answer(sum_=2)), "wrong answer", "2 instead of 8"),
        (single_calls((), answer(sum_=0)), "response field not set", "instead of 8"),
        (single_calls((), answer(sum_=None), stuck=IN_CALL), "deadlock by call()", "line 12"),
        (single_calls((), answer(sum_=None), stuck=IN_WORKER), "blocked executor", "line 12"),
        (single_calls((), answer(sum_=None), spins=False), "no spin", "/node"),
        (SingleCalls(CRASHED), "unhandled exception", "line 12"),
        (SingleCalls(NO_NODE), "no node", ""),
        (SingleCalls(trace(graph=NODE_UP)), "service missing", SERVICE),
        (SingleCalls(trace(graph=graph(services={"/slow_sum": TYPE}))), "wrong service name", "/slow_sum"),
        (SingleCalls(trace(graph=graph(services={"/me/slow_add": TYPE}))), "wrong service name", "namespace"),
        (SingleCalls(trace(graph=graph(services={SERVICE: "std_srvs/srv/Trigger"}))), "wrong type", "Trigger"),
        (
            SingleCalls(trace(graph=graph(services={"/node/get_parameters": "rcl_interfaces/srv/GetParameters"}))),
            "service missing",
            SERVICE,
        ),
    ],
)
def test_causes_of_a_wrong_or_missing_answer(seen: SingleCalls, cause: str, word: str) -> None:
    assert_failed(judge_blocking(seen), cause, word)


def test_verdicts_on_single_calls_so_far() -> None:
    assert_failed(judge_blocks_so_far(single_calls((), answer(sum_=9))), "wrong answer")
    assert_passed(judge_blocks_so_far(single_calls()))
    assert judge_blocks_so_far(single_calls((), answer(sum_=None))) is None


def test_one_call_that_lasts_long_enough_by_chance_is_not_enough() -> None:
    assert_passed(judge_blocking(single_calls(), concurrent(*SUMS, took_s=(3.0, 6.0, 9.0))))
    by_chance = concurrent(*SUMS, took_s=(2.3, 2.3, 2.3))
    assert_failed(judge_blocking(single_calls(), by_chance), "wrong duration", "2.30 s")
    # If sums are mixed up, `concurrent` reports that.
    assert_passed(judge_blocking(single_calls(), concurrent(3005, 3005, 3005, took_s=(2.3, 2.3, 2.3))))
