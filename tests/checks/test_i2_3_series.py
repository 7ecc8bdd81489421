"""I2.3: which log messages are taken for the timer's, whatever their wording."""

from __future__ import annotations

import random
from dataclasses import replace
from typing import Any

import pytest

from checks.i2_3_multi_threaded_service.calls import Call
from checks.i2_3_multi_threaded_service.idle_run import logs_since
from checks.i2_3_multi_threaded_service.judges import judge_timer
from checks.i2_3_multi_threaded_service.timer_logs import all_series
from checks.i2_3_multi_threaded_service.timer_pace import Fault, measure_timer
from tests.checks.builders import EXECUTING, START, assert_passed, frame
from tests.checks.slow_add import (
    CALLED_AT,
    IN_WORKER,
    WAITING,
    Text,
    answer,
    assert_failed,
    assert_told,
    idle_run,
    log_at,
    logged_by,
    series_in,
    single_calls,
    tick_logs,
)
from tutor.judge.trace import LogRecord

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


HEARTBEAT = [log_at(f"heartbeat {n}", START + n) for n in range(1, 9)]
GREETING = [log_at(f"loading module {n}", START + n / 1000) for n in range(300)]
BLOCKED = tick_logs(pause=(0.4, 3.3))
NUMBERS, BLOCKED_NUMBERS = tick_logs("{}".format), tick_logs("{}".format, pause=(0.4, 3.3))
MONITOR = [log_at(f"{n}", START + n / 2 + 0.01, node="monitor") for n in range(1, 10)]
SAID = logged_by("say", tick_logs(every=1, until_s=2.1))
STEPS = [log_at(f"working, step {n} of 30", CALLED_AT + 0.1 * (n + 1)) for n in range(30)]
SAID_BLOCKED = logged_by("say", [*tick_logs(every=1, pause=(0.35, 3.3)), *STEPS])
AT_100_HZ = logged_by("on_timer", tick_logs(lambda n: f"tick {n} of {n % 7}, {n % 3} calls", hz=100, every=10))


LOGS: dict[str, tuple[list[LogRecord], list[LogRecord], str, str]] = {
    "a greeting is no timer": ([*GREETING, *tick_logs()], [*GREETING, *tick_logs()], "passed", ""),
    "a second, slow timer": ([*tick_logs(), *HEARTBEAT], [*tick_logs(), *HEARTBEAT], "passed", ""),
    "the fast one of two stops": ([*tick_logs(), *HEARTBEAT], [*BLOCKED, *HEARTBEAT], WAITING, ""),
    "only the slow one": (HEARTBEAT, HEARTBEAT, "wrong rate", "1.0 times"),
    "a function that says everything is no timer": (SAID, SAID_BLOCKED, WAITING, ""),
    "every tenth of 100 a second": (AT_100_HZ, AT_100_HZ, "wrong rate", "100.0 times"),
    "another node with the same words": ([*NUMBERS, *MONITOR], [*NUMBERS, *MONITOR], "passed", ""),
    "only the other node goes on": ([*NUMBERS, *MONITOR], [*BLOCKED_NUMBERS, *MONITOR], WAITING, ""),
}


@pytest.mark.parametrize(("alone", "during_call", "told", "words"), LOGS.values(), ids=LOGS)
def test_which_messages_are_ticks(alone: list[LogRecord], during_call: list[LogRecord], told: str, words: str) -> None:
    assert_told(judge_timer(idle_run(alone), single_calls(during_call)), told, words)


def test_a_greeting_of_many_messages_is_no_series() -> None:
    assert all_series(GREETING) == []


def test_startup_messages_are_not_a_timer() -> None:
    loading = [log_at(f"loading part {n}", START + n / 10) for n in range(30)]
    later = [replace(log, stamp=log.stamp + 3) for log in tick_logs()]
    found = all_series(logs_since([*loading, *later], START + 3))
    assert {tick.text for series in found for tick in series.ticks} == {log.text for log in later}


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


def test_timestamps_are_not_tick_numbers() -> None:
    (series,) = series_in(tick_logs(lambda n: f"{n * 100_000_000} ns", every=1))
    assert not series.numbered
    assert measure_timer(series, [], Call(answer(3.0, asked_at=START), START + 4)).fault is Fault.GAP
