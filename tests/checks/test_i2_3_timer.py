"""I2.3: verdicts on fabricated logs of a timer: alone, and while the service works."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from checks.i2_3_multi_threaded_service.calls import Call
from checks.i2_3_multi_threaded_service.idle_run import IdleRun
from checks.i2_3_multi_threaded_service.judges import judge_idle_timer, judge_timer, judge_timer_so_far
from checks.i2_3_multi_threaded_service.single_calls import SingleCalls
from tests.checks.builders import (
    CRASHED,
    NODE_UP,
    START,
    assert_passed,
    assert_skipped,
    ending,
    exited,
    lines,
    trace,
)
from tests.checks.slow_add import (
    CALLED_AT,
    IN_WORKER,
    SERVING,
    WAITING,
    answer,
    assert_failed,
    assert_told,
    idle_run,
    log_at,
    single_calls,
    tick_logs,
)
from tutor.judge.trace import LogRecord
from tutor.judge.verdict import Status

EVERY = tick_logs(every=1)
TICKS = tick_logs(lambda n: "tick", every=1)
BURST = [log_at(f"Timer tick: {n}", START + 3.32 + n / 1e4) for n in range(3, 34)]
CAUGHT_UP = [*tick_logs(every=1, until_s=0.25), *BURST, *EVERY[33:]]
AT_ONCE = [log_at("Timer tick: 99", START + 3.2 + n / 1e3) for n in range(20)]
WITHOUT_EVERY_SECOND = [tick for n, tick in enumerate(TICKS) if n % 2 or not 3 < n < 33]


def every_tick_but(start_s: float, end_s: float, until_s: float = 4.6) -> list[LogRecord]:
    return tick_logs(every=1, pause=(start_s, end_s), until_s=until_s)


LONG = {"until": START + 8, "stuck": IN_WORKER}
LOGS: dict[str, tuple[list[LogRecord], dict[str, Any], str, str]] = {
    "pauses for part of the call": (every_tick_but(1.2, 2.6, until_s=8), LONG, "timer pauses", "1.5 s"),
    "catches up in a burst": (CAUGHT_UP, {"stuck": IN_WORKER}, "timer waits for the service", ""),
    "a burst without a gap": ([*EVERY, *AT_ONCE], {}, "ticks in a burst", ""),
    "a gap on a busy machine": (every_tick_but(0.5, 1.6), {"cpu_wait_s": 1.0}, "passed", ""),
    "a longer gap on a busy machine": (every_tick_but(0.5, 2), {"cpu_wait_s": 0.7}, "undecided", ""),
    "stops for the call on a busy machine": (every_tick_but(0.3, 3.3), {"cpu_wait_s": 0.7}, WAITING, ""),
}


@pytest.mark.parametrize(("during_call", "how", "told", "words"), LOGS.values(), ids=LOGS)
def test_a_timer_of_ten_messages_a_second(
    during_call: list[LogRecord], how: dict[str, Any], told: str, words: str
) -> None:
    assert_told(judge_timer(idle_run(EVERY), single_calls(during_call, **how)), told, words)


def test_a_timer_of_one_message_a_second() -> None:
    assert_failed(judge_timer(idle_run(tick_logs()), single_calls(tick_logs(until_s=2))), WAITING)  # never resumes
    # The timer stops for the whole call: no machine is so busy that this passes.
    stopped = single_calls(tick_logs(pause=(0.3, 3.3)), cpu_wait_s=2.5)
    assert_told(judge_timer(idle_run(tick_logs()), stopped), "undecided")
    assert_told(judge_timer(idle_run(tick_logs(hz=7), pace_slowed=True), single_calls()), "undecided")


def test_a_number_that_hardly_changes_is_not_the_number_of_the_tick() -> None:
    logs = [tick_logs(lambda n: f"tick, battery at {100 - n // 12} %", every=1, until_s=s) for s in (3.6, 4.7)]
    assert_passed(judge_timer(idle_run(logs[0]), single_calls(logs[1])))


def test_every_second_tick_is_skipped_during_a_call() -> None:
    assert_failed(judge_timer(idle_run(TICKS), single_calls(WITHOUT_EVERY_SECOND)), "slowed timer")


def test_verdicts_on_the_timer_so_far() -> None:
    idle = idle_run(EVERY)
    logs, paused, still = (tick_logs(every=1, until_s=8, pause=pause) for pause in (None, (1.2, 2.6), (0.3, 3.31)))
    assert_passed(judge_timer_so_far(single_calls(logs, until=START + 8, idle=idle)))
    assert_failed(judge_timer_so_far(single_calls(paused, until=START + 8, idle=idle)), "timer pauses")
    # Still unknown: where the timer waits, or what it does without a call.
    assert judge_timer_so_far(single_calls(still, until=START + 8, idle=idle)) is None
    assert judge_timer_so_far(single_calls(paused, until=START + 8)) is None


def test_a_wrong_timer_period_fails_without_a_call() -> None:
    assert judge_idle_timer(idle_run(tick_logs(every=1))) is None
    assert judge_idle_timer(idle_run(())) is None
    assert_failed(judge_idle_timer(idle_run(tick_logs(hz=20.0, every=1))), "wrong rate")


def test_a_process_that_ends_after_a_call() -> None:
    seen = single_calls(tick_logs(until_s=4.0), until=START + 4.1)
    gone = replace(seen, trace=replace(seen.trace, exit=exited(0, after_s=4.1)))
    assert_failed(judge_timer(idle_run(tick_logs()), gone), "exit at once", "exit code 0")


def test_the_timer_is_also_judged_during_a_second_call() -> None:
    later = answer(asked_at=START + 4.8)
    whole, still = (tick_logs(until_s=10, every=5, pause=pause) for pause in (None, (5.0, 7.9)))
    for logs, right in ((whole, True), (still, False)):
        seen = replace(single_calls(logs), later=single_calls((), later, until=START + 9).calls)
        verdict = judge_timer(idle_run(tick_logs(every=5)), seen)
        assert verdict.passed == right
        assert right or verdict.observed.startswith("the second call: ")


@given(st.floats(0.2, 7.5) | st.floats(12.6, 100), st.sampled_from([1, 2, 5, 10]))
def test_other_timer_rates_fail(hz: float, every: int) -> None:
    alone = idle_run(tick_logs(hz=hz, every=every, until_s=1.2 + 4.1 * every / hz))
    assert_failed(judge_timer(alone, single_calls()), "wrong rate", "times a second")


@given(st.floats(8.5, 11.5), st.sampled_from([1, 2, 5, 10]), st.integers(0, 100), st.floats(0, 0.03))
def test_jitter_passes(hz: float, every: int, seed: int, jitter_s: float) -> None:
    def logs(until_s: float, seed: int) -> list[LogRecord]:
        return tick_logs(hz=hz, every=every, until_s=until_s, jitter_s=jitter_s, seed=seed)

    assert_passed(judge_timer(idle_run(logs(3.6, seed)), single_calls(logs(4.7, seed + 1))))


@given(st.floats(0.3, 1.5), st.floats(1.2, 3.0), st.sampled_from([1, 2, 5]))
def test_a_gap_of_more_than_a_second_fails(start: float, length: float, every: int) -> None:
    logs = tick_logs(every=every, pause=(start, start + length), until_s=6)
    verdict = judge_timer(idle_run(tick_logs(every=every)), single_calls(logs, until=START + 6))
    assert verdict.status is Status.FAILED


def test_a_call_that_needs_no_excuse_outweighs_one_that_does() -> None:
    kept = [log for n, log in enumerate(tick_logs(lambda n: "tick", every=1)) if n % 3 or not 3 < n < 33]
    later = [replace(log, stamp=log.stamp + 5) for n, log in enumerate(kept)]
    first, second = answer(), answer(asked_at=CALLED_AT + 5)
    alone = idle_run(tick_logs(lambda n: "tick", every=1))
    calls = (Call(first, START + 4.7, 1.0), Call(second, START + 9.7, 0.0))
    slowed = SingleCalls(trace(graph=SERVING, logs=[*kept, *later]), calls)
    assert_failed(judge_timer(alone, slowed), "slowed timer")
    assert_passed(judge_timer(alone, replace(slowed, calls=calls[:1])))


def test_causes_of_no_timer_messages() -> None:
    assert_failed(judge_timer(idle_run([log_at("Ready", START)]), single_calls(tick_logs(every=1))), "not logged")
    ticks = "\n".join(f"tick {n}" for n in range(20))
    printing = IdleRun(trace(graph=SERVING, out=ticks))
    assert_failed(judge_timer(printing, single_calls()), "printed, not logged", "the timer's message")
    late = IdleRun(trace(graph=SERVING), ending=replace(ending(), output=lines(ticks, "stdout")))
    assert_failed(judge_timer(late, single_calls()), "output held back by buffering")
    assert_failed(judge_timer(IdleRun(CRASHED), single_calls()), "unhandled exception", "line 12")


def test_a_timer_is_not_judged_without_a_call() -> None:
    assert_skipped(judge_timer(idle_run(tick_logs()), SingleCalls(trace(graph=NODE_UP))), "")
    assert_failed(judge_timer(idle_run(tick_logs(hz=5)), SingleCalls(trace(graph=NODE_UP))), "wrong rate")
