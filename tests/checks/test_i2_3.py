"""I2.3: verdicts on fabricated timer logs and service calls."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from checks.i2_3_multi_threaded_service import CHECK
from checks.i2_3_multi_threaded_service.call_scenarios import ConcurrentCalls, Interrupted
from checks.i2_3_multi_threaded_service.calls import (
    MAX_AT_ONCE_TRIES,
    SLOW_ADD,
    Call,
    CallBatch,
    needs_repeat_at_once,
)
from checks.i2_3_multi_threaded_service.idle_run import IdleRun, logs_since
from checks.i2_3_multi_threaded_service.judges import (
    judge_blocks,
    judge_blocks_so_far,
    judge_concurrent,
    judge_concurrent_so_far,
    judge_idle_timer,
    judge_parallel,
    judge_shutdown_busy,
    judge_timer,
    judge_timer_so_far,
)
from checks.i2_3_multi_threaded_service.single_calls import SingleCalls
from checks.i2_3_multi_threaded_service.timer_logs import Series, all_series, timer_series
from checks.i2_3_multi_threaded_service.timer_pace import MAX_TRIES, TRIES, Fault, Watch, measure_timer
from tests.checks import builders
from tests.checks.builders import (
    CRASHED,
    KEYBOARD_INTERRUPT,
    NO_NODE,
    NODE_UP,
    START,
    assert_passed,
    assert_skipped,
    assert_undecided,
    ending,
    exited,
    frame,
    graph,
    judge_of,
    lines,
    trace,
)
from tutor.judge.trace import CallAnswer, LogRecord
from tutor.judge.verdict import Status, Verdict

assert_failed = partial(builders.assert_failed, check=CHECK)
judge_shutdown = judge_of(CHECK, "shutdown")

SERVICE, TYPE = SLOW_ADD.name, SLOW_ADD.type

SERVING = graph(services={SERVICE: TYPE})
CALLED_AT = START + 0.3
EXECUTING = frame("await_or_execute", "/venv/rclpy/executors.py")
ASLEEP = frame("slow_add", code="time.sleep(3.0)")
IN_WORKER = (ASLEEP, EXECUTING, frame("_worker", "/usr/lib/python3.12/concurrent/futures/thread.py"))
IN_CALL = (frame("call", "/venv/rclpy/client.py"), frame("slow_add"), EXECUTING)

WAITING = "callbacks wait for each other"

Text = Callable[[int], str]


def log_at(text: str, at: float, level: int = 20, *, node: str = "node", function: str = "") -> LogRecord:
    return LogRecord(level, node, text, at, at, function)


def logged_by(function: str, logs: Sequence[LogRecord]) -> list[LogRecord]:
    return [replace(log, function=function) for log in logs]


def tick_logs(
    text: Text = "Timer tick: {}".format,
    *,
    until_s: float = 4.6,
    every: int = 10,
    hz: float = 10.0,
    jitter_s: float = 0.0,
    pause: tuple[float, float] | None = None,
    seed: int = 1,
) -> list[LogRecord]:
    """A timer's log messages from START on. In `pause` (from, to; seconds after START), it neither ticks nor counts."""
    rng = random.Random(seed)
    logs: list[LogRecord] = []
    number = step = 0
    while (at := (step := step + 1) / hz) <= until_s:
        if pause and pause[0] <= at < pause[1]:
            continue
        number += 1
        if number % every == 0:
            logs.append(log_at(text(number), START + at + rng.uniform(0, jitter_s)))
    return logs


def series_in(logs: Sequence[LogRecord]) -> tuple[Series, ...]:
    return timer_series(all_series(logs))


def answer(
    took_s: float = 3.01, a: int = 5, b: int = 3, sum_: int | None = 8, asked_at: float = CALLED_AT
) -> CallAnswer:
    response = None if sum_ is None else {"sum": sum_}
    return CallAnswer(SERVICE, {"a": a, "b": b}, response, asked_at, asked_at + took_s)


def single_calls(
    logs: Sequence[LogRecord] = (),
    *called: CallAnswer,
    cpu_wait_s: float = 0.0,
    until: float = START + 4.7,
    **more: Any,
) -> SingleCalls:
    calls = tuple(Call(each, until, cpu_wait_s) for each in called or (answer(),))
    return SingleCalls(trace(graph=SERVING, logs=logs), calls, **more)


def idle_run(logs: Sequence[LogRecord], **more: Any) -> IdleRun:
    return IdleRun(trace(graph=SERVING, logs=logs), series_in(logs), **more)


def judge_blocking(seen: SingleCalls, several: ConcurrentCalls | None = None) -> Verdict:
    return judge_blocks(seen, several or ConcurrentCalls(trace()))


@given(st.floats(2.8, 3.35), st.integers(-900, 900), st.integers(-900, 900))
def test_an_answer_after_three_seconds_passes(took_s: float, a: int, b: int) -> None:
    assert_passed(judge_blocking(single_calls((), answer(took_s, a, b, a + b))))


@given(st.floats(0, 2.7) | st.floats(3.5, 12))
def test_other_durations_fail(took_s: float) -> None:
    assert_failed(judge_blocking(single_calls((), answer(took_s))), "wrong duration", "not after 3 s")


def test_a_busy_machine_excuses_slow_answers_but_not_quick_ones() -> None:
    assert_passed(judge_blocking(single_calls((), answer(3.7), cpu_wait_s=0.4)))
    assert_passed(judge_blocking(single_calls((), answer(4.2), answer(3.3))))
    assert_failed(judge_blocking(single_calls((), answer(2.6), cpu_wait_s=2.0)), "wrong duration")
    assert_failed(judge_blocking(single_calls((), answer(4.0), cpu_wait_s=0.6)), "wrong duration", "4.0 s")
    assert_failed(judge_blocking(single_calls((), answer(4.5), cpu_wait_s=1.0)), "wrong duration", "4.5 s")
    assert_failed(judge_blocking(single_calls((), answer(4.5), answer(4.1))), "wrong duration", "4.1 s")
    assert_undecided(judge_blocking(single_calls((), answer(4.2), cpu_wait_s=1.0)))
    assert_undecided(judge_blocking(single_calls((), answer(5.7), cpu_wait_s=6.1)))  # a starved machine
    assert_failed(judge_blocking(single_calls((), answer(5.7), cpu_wait_s=1.5)), "wrong duration", "5.7 s")


def test_one_late_call_on_a_calm_machine_is_enough_to_fail() -> None:
    busy, calm = single_calls((), answer(4.05), cpu_wait_s=0.9), single_calls((), answer(4.2), cpu_wait_s=0.3)
    for calls in (busy.calls + calm.calls, calm.calls + busy.calls):
        assert_failed(judge_blocking(replace(busy, calls=calls)), "wrong duration", "4.0 s")
    assert_undecided(judge_blocking(replace(busy, calls=busy.calls * 2)))


def calls_made(each: Call, logs: Sequence[LogRecord] = (), *, most: int = MAX_TRIES, calm_at: int = 99) -> int:
    """The number of calls made, if each is like this one; from number `calm_at` on, the machine is calm."""
    made: list[Call] = []
    while not made or Watch(logs, series_in(tick_logs(every=1))).needs_repeat(made, most):
        made.append(each if len(made) + 1 < calm_at else replace(each, cpu_wait_s=0.0))
    return len(made)


def test_a_timer_that_stops_for_the_whole_call_needs_no_repetition_unless_the_machine_is_busy() -> None:
    (calm,), (busy,) = single_calls().calls, single_calls((), cpu_wait_s=2.5).calls
    stopped = tick_logs(every=1, until_s=5.5, pause=(0.4, 3.3))
    assert calls_made(calm, stopped) == 1
    assert calls_made(replace(calm, cpu_wait_s=0.5), stopped) == 1
    assert calls_made(busy, stopped, calm_at=2) == 2
    assert calls_made(calm, tick_logs(every=1, until_s=5.5, pause=(0.4, 2.5))) == 2
    assert calls_made(replace(calm, answer=answer(4.1)), tick_logs(every=1, until_s=5.5, pause=(0.4, 4.4))) == 2


def test_a_slow_series_shows_no_stop_within_a_call() -> None:
    (call,) = single_calls().calls
    slow = series_in(tick_logs(every=20, until_s=9.0))
    assert not Watch([], slow).is_stopped(call)
    assert Watch([], series_in(tick_logs())).is_stopped(call)
    assert not Watch([], ()).is_stopped(call)


def test_calls_are_repeated_until_the_machine_is_not_to_blame() -> None:
    (good,), (late,) = single_calls((), cpu_wait_s=1.0).calls, single_calls((), answer(4.1), cpu_wait_s=1.0).calls
    ticks, gap = tick_logs(every=1, until_s=5.5), tick_logs(every=1, until_s=5.5, pause=(0.5, 2))
    assert calls_made(replace(good, cpu_wait_s=0.0), ticks) == 1
    assert calls_made(replace(late, cpu_wait_s=0.0), ticks) == 2
    assert calls_made(late, ticks) == calls_made(replace(good, cpu_wait_s=0.7), gap) == MAX_TRIES
    assert calls_made(late, ticks, most=TRIES) == TRIES
    assert calls_made(late, ticks, calm_at=3) == 3
    assert calls_made(late, ticks, calm_at=6) == 6
    assert calls_made(replace(good, cpu_wait_s=0.7), gap, calm_at=6) == 6
    assert calls_made(replace(late, cpu_wait_s=0.3), ticks) == TRIES  # each is conclusive, another might be in time
    assert calls_made(replace(late, answer=answer(5.0)), ticks) == 2
    assert calls_made(replace(late, answer=answer(sum_=None)), ticks) == 1


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
            judge_blocking(with_second_call(called), concurrent(1005, 2005, 3005)),
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


TEXTS: list[Text] = [
    "Timer tick: {}".format,
    "{}".format,
    "[{:05d}] still alive".format,
    "10 Hz timer: tick {}".format,
    "⏰ {} ticks".format,
    "Takt Nummer {}".format,
    "таймер {}".format,
    lambda n: f"tick #{n} at {START + n / 10:.2f}, 3 calls",
    lambda n: f"{START + n / 10:.3f} tick {n}",
    lambda n: f"elapsed {n / 10:.1f} s, tick {n}",
    lambda n: f"ticks left: {1000 - n}",
    lambda n: f"tick {n} ({'BUSY' if 3 < n < 33 else 'idle'})",
    lambda n: f"#{n} last result: {'none yet' if n < 33 else '5 + 3 = 8'}",
    lambda n: f"tick {n}: {random.Random(n).choice(['still here', 'alive', 'going strong'])}",
]


@pytest.mark.parametrize("text", TEXTS)
@pytest.mark.parametrize("every", [1, 2, 5, 10, 20])
def test_a_timer_that_keeps_ticking_passes(text: Text, every: int) -> None:
    alone = idle_run(tick_logs(text, until_s=8, every=every))
    during_call = [
        *tick_logs(text, every=every),
        log_at("Service called: 5 + 3", CALLED_AT),
        *(log_at(f"working: {percent} %", CALLED_AT + percent / 34) for percent in range(0, 100, 3)),
        log_at("Service complete: 8", CALLED_AT + 3.01),
    ]
    assert_passed(judge_timer(alone, single_calls(during_call)))


@pytest.mark.parametrize("text", TEXTS)
@pytest.mark.parametrize("every", [1, 5, 10, 20])
def test_a_timer_that_stops_during_a_call_fails(text: Text, every: int) -> None:
    alone = idle_run(tick_logs(text, until_s=8, every=every))
    blocked = tick_logs(text, every=every, pause=(0.3, 3.31), until_s=8)
    seen = single_calls(blocked, until=START + 8, stuck=IN_WORKER)
    assert_failed(judge_timer(alone, seen), "timer waits for the service", "line 12", "callback groups")
    alone_thread = single_calls(blocked, until=START + 8, stuck=(frame("slow_add"), EXECUTING))
    assert_failed(judge_timer(alone, alone_thread), "one thread for all callbacks", "line 12")


def test_verdicts_on_single_calls_so_far() -> None:
    logs, idle = tick_logs(every=1, until_s=8), idle_run(tick_logs(every=1))
    paused = tick_logs(every=1, pause=(1.2, 2.6), until_s=8)
    still = tick_logs(every=1, pause=(0.3, 3.31), until_s=8)
    assert_passed(judge_timer_so_far(single_calls(logs, until=START + 8, idle=idle)))
    assert_failed(judge_timer_so_far(single_calls(paused, until=START + 8, idle=idle)), "timer pauses")
    # Still unknown: where the timer waits, or what it does without a call.
    assert judge_timer_so_far(single_calls(still, until=START + 8, idle=idle)) is None
    assert judge_timer_so_far(single_calls(paused, until=START + 8)) is None
    assert_failed(judge_blocks_so_far(single_calls(logs, answer(sum_=9))), "wrong answer")
    assert_passed(judge_blocks_so_far(single_calls(logs)))
    assert judge_blocks_so_far(single_calls(logs, answer(sum_=None))) is None


def test_a_wrong_timer_period_fails_without_a_call() -> None:
    assert judge_idle_timer(idle_run(tick_logs(every=1))) is None
    assert judge_idle_timer(idle_run(())) is None
    assert_failed(judge_idle_timer(idle_run(tick_logs(hz=20.0, every=1))), "wrong rate")


def test_a_timer_that_pauses_for_part_of_a_call() -> None:
    logs = tick_logs(every=1, pause=(1.2, 2.6), until_s=8)
    verdict = judge_timer(idle_run(tick_logs(every=1)), single_calls(logs, until=START + 8, stuck=IN_WORKER))
    assert_failed(verdict, "timer pauses", "1.5 s")


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


UNNUMBERED: list[Text] = [
    lambda n: "tick",
    lambda n: f"alive at {START + n / 10:.3f}",
    lambda n: f"up for {n * 100} ms",
    lambda n: "tick" if n % 2 else "tock",
    lambda n: f"tick ({'adding 5 and 3' if 3 < n < 33 else 'nothing to do'})",
    lambda n: "|/-\\"[n % 4],
]


@pytest.mark.parametrize("text", UNNUMBERED)
def test_unnumbered_messages_at_10_hz_are_the_timer(text: Text) -> None:
    assert_passed(judge_timer(idle_run(tick_logs(text, every=1)), single_calls(tick_logs(text, every=1))))
    blocked = tick_logs(text, every=1, pause=(0.4, 3.3))
    assert_failed(judge_timer(idle_run(tick_logs(text, every=1)), single_calls(blocked)), WAITING)


@pytest.mark.parametrize("text", UNNUMBERED[:3])
def test_unnumbered_messages_at_1_hz_are_not_a_10_hz_timer(text: Text) -> None:
    assert_failed(
        judge_timer(idle_run(tick_logs(text, every=10)), single_calls(tick_logs(text))), "wrong rate", "no number"
    )


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


def test_the_machine_is_to_blame_for_a_gap_when_it_is_busy() -> None:
    blocked = tick_logs(every=1, pause=(0.5, 1.6))
    assert_passed(judge_timer(idle_run(tick_logs(every=1)), single_calls(blocked, cpu_wait_s=1.0)))
    for_long = tick_logs(every=1, pause=(0.5, 2))
    assert_undecided(judge_timer(idle_run(tick_logs(every=1)), single_calls(for_long, cpu_wait_s=0.7)))
    long = single_calls(tick_logs(every=1, pause=(0.3, 3.3)), cpu_wait_s=0.7)
    assert_failed(judge_timer(idle_run(tick_logs(every=1)), long), WAITING)
    # The timer stops for the whole call: no machine is so busy that this passes.
    assert_undecided(judge_timer(idle_run(tick_logs()), single_calls(tick_logs(pause=(0.3, 3.3)), cpu_wait_s=2.5)))
    assert_undecided(judge_timer(idle_run(tick_logs(hz=7), pace_slowed=True), single_calls()))


def test_ticks_caught_up_in_a_burst_are_still_a_gap() -> None:
    burst = [log_at(f"Timer tick: {n}", START + 3.32 + n / 1e4) for n in range(3, 34)]
    logs = [*tick_logs(every=1, until_s=0.25), *burst, *tick_logs(every=1)[33:]]
    assert_failed(
        judge_timer(idle_run(tick_logs(every=1)), single_calls(logs, stuck=IN_WORKER)), "timer waits for the service"
    )


def test_a_burst_without_a_gap() -> None:
    logs = [*tick_logs(every=1), *(log_at("Timer tick: 99", START + 3.2 + n / 1e3) for n in range(20))]
    assert_failed(judge_timer(idle_run(tick_logs(every=1)), single_calls(logs)), "ticks in a burst")


def test_every_second_tick_is_skipped_during_a_call() -> None:
    kept = [log for n, log in enumerate(tick_logs(lambda n: "tick", every=1)) if n % 2 or not 3 < n < 33]
    assert_failed(judge_timer(idle_run(tick_logs(lambda n: "tick", every=1)), single_calls(kept)), "slowed timer")


def test_a_call_that_needs_no_excuse_outweighs_one_that_does() -> None:
    kept = [log for n, log in enumerate(tick_logs(lambda n: "tick", every=1)) if n % 3 or not 3 < n < 33]
    later = [replace(log, stamp=log.stamp + 5) for n, log in enumerate(kept)]
    first, second = answer(), answer(asked_at=CALLED_AT + 5)
    alone = idle_run(tick_logs(lambda n: "tick", every=1))
    calls = (Call(first, START + 4.7, 1.0), Call(second, START + 9.7, 0.0))
    slowed = SingleCalls(trace(graph=SERVING, logs=[*kept, *later]), calls)
    assert_failed(judge_timer(alone, slowed), "slowed timer")
    assert_passed(judge_timer(alone, replace(slowed, calls=calls[:1])))


def test_a_timer_that_never_resumes() -> None:
    assert_failed(judge_timer(idle_run(tick_logs()), single_calls(tick_logs(until_s=2))), WAITING)


def test_causes_of_no_timer_messages() -> None:
    assert_failed(judge_timer(idle_run([log_at("Ready", START)]), single_calls(tick_logs(every=1))), "not logged")
    ticks = "\n".join(f"tick {n}" for n in range(20))
    printing = IdleRun(trace(graph=SERVING, out=ticks))
    assert_failed(judge_timer(printing, single_calls()), "printed, not logged", "the timer's message")
    late = IdleRun(trace(graph=SERVING), ending=replace(ending(), output=lines(ticks, "stdout")))
    assert_failed(judge_timer(late, single_calls()), "output held back by buffering")
    assert_failed(judge_timer(IdleRun(CRASHED), single_calls()), "unhandled exception", "line 12")


def test_a_greeting_of_many_messages_is_not_a_timer() -> None:
    greeting = [log_at(f"loading module {n}", START + n / 1000) for n in range(300)]
    assert all_series(greeting) == []
    assert_passed(judge_timer(idle_run([*greeting, *tick_logs()]), single_calls([*greeting, *tick_logs()])))


def test_startup_messages_are_not_a_timer() -> None:
    loading = [log_at(f"loading part {n}", START + n / 10) for n in range(30)]
    later = [replace(log, stamp=log.stamp + 3) for log in tick_logs()]
    found = all_series(logs_since([*loading, *later], START + 3))
    assert {tick.text for series in found for tick in series.ticks} == {log.text for log in later}


def test_a_second_timer_is_not_taken_for_the_fast_one() -> None:
    slow = [log_at(f"heartbeat {n}", START + n) for n in range(1, 9)]
    alone = idle_run([*tick_logs(), *slow])
    assert_passed(judge_timer(alone, single_calls([*tick_logs(), *slow])))
    blocked = tick_logs(pause=(0.4, 3.3))
    assert_failed(judge_timer(alone, single_calls([*blocked, *slow])), WAITING)
    assert_failed(judge_timer(idle_run(slow), single_calls(slow)), "wrong rate", "1.0 times")


def roman(number: int) -> str:
    text = ""
    for value, sign in ((50, "L"), (40, "XL"), (10, "X"), (9, "IX"), (5, "V"), (4, "IV"), (1, "I")):
        text += sign * (number // value)
        number %= value
    return text


DURING_CALL = range(4, 33)
VARYING_TEXTS: list[tuple[Text, int]] = [
    (lambda n: f"Service works, timer runs all the same: {n}" if n in DURING_CALL else f"Idle, tick {n}", 10),
    (lambda n: f"still ticking ({n}) during the call" if n in DURING_CALL else f"Tick {n}", 1),
    (lambda n: "still ticking during the call" if n in DURING_CALL else "tick", 1),
    (lambda n: f"Tick {roman(n)}", 1),
    (lambda n: f"tick {n:#06x}", 1),
]


@pytest.mark.parametrize(("text", "every"), VARYING_TEXTS)
def test_messages_of_one_function_are_one_timer_whatever_the_wording(text: Text, every: int) -> None:
    def logs(**more: Any) -> list[LogRecord]:
        return logged_by("on_timer", tick_logs(text, every=every, **more))

    service = logged_by("slow_add", [log_at(f"working, step {n} of 30", CALLED_AT + n / 10) for n in range(30)])
    assert_passed(judge_timer(idle_run(logs(until_s=2.1)), single_calls([*logs(), *service])))
    blocked = single_calls([*logs(pause=(0.4, 3.3)), *service])
    assert_failed(judge_timer(idle_run(logs(until_s=2.1)), blocked), WAITING)


def test_service_messages_logged_by_a_shared_function_are_not_ticks() -> None:
    alone = idle_run(logged_by("say", tick_logs(every=1, until_s=2.1)))
    steps = [log_at(f"working, step {n} of 30", CALLED_AT + 0.1 * (n + 1)) for n in range(30)]
    blocked = single_calls(logged_by("say", [*tick_logs(every=1, pause=(0.35, 3.3)), *steps]))
    assert_failed(judge_timer(alone, blocked), WAITING)


def test_a_function_that_counts_at_100_hz_is_not_a_10_hz_timer() -> None:
    fast = logged_by("on_timer", tick_logs(lambda n: f"tick {n} of {n % 7}, {n % 3} calls", hz=100, every=10))
    assert_failed(judge_timer(idle_run(fast), single_calls(fast)), "wrong rate", "100.0 times")


def test_two_nodes_may_use_the_same_wording() -> None:
    slow = [log_at(f"{n}", START + n / 2 + 0.01, node="monitor") for n in range(1, 10)]
    assert_passed(
        judge_timer(idle_run([*tick_logs("{}".format), *slow]), single_calls([*tick_logs("{}".format), *slow]))
    )
    blocked = tick_logs("{}".format, pause=(0.4, 3.3))
    assert_failed(judge_timer(idle_run([*tick_logs("{}".format), *slow]), single_calls([*blocked, *slow])), WAITING)


@pytest.mark.parametrize("every", [1, 5, 10])
@pytest.mark.parametrize("size", [20, 30, 40])
def test_a_counter_may_start_over(size: int, every: int) -> None:
    def logs(**more: Any) -> list[LogRecord]:
        return [
            replace(log, text=f"tick {int(log.text) % size}") for log in tick_logs("{}".format, every=every, **more)
        ]

    alone = idle_run(tick_logs("tick {}".format, every=every, until_s=2.1))
    assert_passed(judge_timer(alone, single_calls(logs())))
    assert_failed(judge_timer(alone, single_calls(logs(pause=(0.4, 3.3)))), WAITING)


def test_a_timer_is_not_judged_without_a_call() -> None:
    assert judge_timer(idle_run(tick_logs()), SingleCalls(trace(graph=NODE_UP))).status is Status.SKIPPED
    assert_failed(judge_timer(idle_run(tick_logs(hz=5)), SingleCalls(trace(graph=NODE_UP))), "wrong rate")


def test_timestamps_are_not_tick_numbers() -> None:
    (series,) = series_in(tick_logs(lambda n: f"{n * 100_000_000} ns", every=1))
    assert not series.numbered
    assert measure_timer(series, [], Call(answer(3.0, asked_at=START), START + 4)).fault is Fault.GAP


def concurrent(
    *sums: int | None, took_s: Sequence[float] = (3.0, 3.0, 3.0), cpu_wait_s: float = 0.0
) -> ConcurrentCalls:
    """One batch of three concurrent calls with these sums; None means that a call was not answered."""
    answers = tuple(answer(took, 1000 * n, 5, sum_) for n, (took, sum_) in enumerate(zip(took_s, sums, strict=True), 1))
    return ConcurrentCalls(trace(graph=SERVING), (CallBatch(answers, cpu_wait_s),))


def test_three_concurrent_calls() -> None:
    assert_passed(judge_concurrent(concurrent(1005, 2005, 3005)))
    assert_passed(judge_concurrent(concurrent(1005, 2005, 3005, took_s=(9.0, 3.0, 6.0))))
    assert_failed(judge_concurrent(concurrent(3005, 3005, 3005)), "shared state", "1 of 3")
    assert_failed(judge_concurrent(concurrent(1005, -1, -1)), "wrong answer", "-1")
    assert_failed(judge_concurrent(concurrent(1005, None, None)), "no answer", "2 of 3")
    assert_failed(
        judge_concurrent(ConcurrentCalls(CRASHED, concurrent(1005, None, None).batches)), "unhandled exception"
    )
    assert judge_concurrent(ConcurrentCalls(trace(graph=NODE_UP))).status is Status.SKIPPED


def test_one_call_that_lasts_long_enough_by_chance_is_not_enough() -> None:
    assert_passed(judge_blocking(single_calls(), concurrent(1005, 2005, 3005, took_s=(3.0, 6.0, 9.0))))
    by_chance = concurrent(1005, 2005, 3005, took_s=(2.3, 2.3, 2.3))
    assert_failed(judge_blocking(single_calls(), by_chance), "wrong duration", "2.30 s")
    # If sums are mixed up, `concurrent` reports that.
    assert_passed(judge_blocking(single_calls(), concurrent(3005, 3005, 3005, took_s=(2.3, 2.3, 2.3))))


def test_calls_that_a_starved_machine_leaves_unanswered_are_no_verdict() -> None:
    starved = concurrent(None, None, None, took_s=(8.0, 8.0, 8.0), cpu_wait_s=9.0)
    assert_undecided(judge_concurrent(starved))
    assert_failed(judge_concurrent(concurrent(None, None, None, took_s=(8.0, 8.0, 8.0), cpu_wait_s=4.0)), "no answer")
    assert_failed(judge_concurrent(concurrent(3005, 3005, 3005, cpu_wait_s=9.0)), "shared state")


def test_three_unanswered_calls_are_judged_only_with_the_single_calls() -> None:
    assert_failed(judge_concurrent_so_far(concurrent(3005, 3005, 3005)), "shared state")
    assert_passed(judge_concurrent_so_far(concurrent(1005, 2005, 3005)))
    assert judge_concurrent_so_far(concurrent(None, None, None)) is None


@given(st.permutations([1005, 2005, 3005]))
def test_each_concurrent_call_gets_its_own_sum(sums: list[int]) -> None:
    right = sums == [1005, 2005, 3005]
    assert judge_concurrent(concurrent(*sums)).status is (Status.PASSED if right else Status.FAILED)


def test_parallel() -> None:
    sums = (1005, 2005, 3005)
    assert_passed(judge_parallel(single_calls(), concurrent(*sums, took_s=(3.0, 3.1, 4.4))))
    assert_passed(judge_parallel(single_calls(), concurrent(*sums, took_s=(3.0, 3.1, 4.9), cpu_wait_s=0.6)))
    again = ConcurrentCalls(
        trace(graph=SERVING), (*concurrent(*sums, took_s=(3.0, 3.1, 5.0)).batches, *concurrent(*sums).batches)
    )
    assert_passed(judge_parallel(single_calls(), again))
    assert_failed(
        judge_parallel(single_calls(), concurrent(*sums, took_s=(3.0, 3.0, 6.0))), WAITING, "some of three calls"
    )
    assert_undecided(judge_parallel(single_calls(), concurrent(*sums, took_s=(3.0, 3.0, 6.0), cpu_wait_s=2.6)))
    assert_failed(
        judge_parallel(single_calls(), concurrent(*sums, took_s=(3.0, 6.0, 9.0), cpu_wait_s=5.0)),
        WAITING,
        "all of three calls",
    )


def test_three_calls_on_a_calm_machine_are_conclusive() -> None:
    (calm,), (busy,) = two_at_a_time(0.3).batches, two_at_a_time(3.0).batches
    for made in ((calm,), (calm, calm), (busy, calm), (busy, calm, busy)):
        assert_failed(
            judge_parallel(single_calls(), ConcurrentCalls(trace(graph=SERVING), made)),
            WAITING,
            "2.0 times",
        )
    for made in ((busy,), (busy, busy), (calm, busy, busy)):  # the first may have been delayed by discovery
        assert_undecided(judge_parallel(single_calls(), ConcurrentCalls(trace(graph=SERVING), made)))


def two_at_a_time(cpu_wait_s: float) -> ConcurrentCalls:
    return concurrent(1005, 2005, 3005, took_s=(3.0, 3.0, 6.0), cpu_wait_s=cpu_wait_s)


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
    made = tuple(batch for each in cpu_wait_s for batch in two_at_a_time(each).batches)
    repeated = [needs_repeat_at_once(made[:n]) for n in range(1, len(made) + 1)]
    assert repeated == [True] * (times - 1) + [False]
    good = concurrent(1005, 2005, 3005, cpu_wait_s=3.0)
    serial = concurrent(1005, 2005, 3005, took_s=(3, 6, 9), cpu_wait_s=3.0)
    assert not needs_repeat_at_once(good.batches)
    assert not needs_repeat_at_once(serial.batches)
    lost = concurrent(1005, None, 3005, took_s=(3.0, 3.0, 6.0), cpu_wait_s=3.0)
    assert not needs_repeat_at_once(lost.batches)


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
    assert judge_shutdown_busy(gone, SingleCalls(trace())).status is Status.SKIPPED
    unanswered = single_calls([], answer(sum_=None))
    assert judge_shutdown_busy(clean, unanswered).status is Status.SKIPPED
    assert_failed(judge_shutdown_busy(stays, unanswered), "does not end")
