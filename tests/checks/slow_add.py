"""I2.3: what could be observed of a service that takes three seconds beside a timer."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from checks.i2_3_multi_threaded_service import CHECK
from checks.i2_3_multi_threaded_service.call_scenarios import ConcurrentCalls
from checks.i2_3_multi_threaded_service.calls import SLOW_ADD, Call, CallBatch
from checks.i2_3_multi_threaded_service.idle_run import IdleRun
from checks.i2_3_multi_threaded_service.single_calls import SingleCalls
from checks.i2_3_multi_threaded_service.timer_logs import Series, all_series, timer_series
from tests.checks import builders
from tests.checks.builders import EXECUTING, START, assert_passed, assert_undecided, frame, graph, trace
from tutor.judge.trace import CallAnswer, LogRecord
from tutor.judge.verdict import Verdict

assert_failed = partial(builders.assert_failed, check=CHECK)

SERVICE, TYPE = SLOW_ADD.name, SLOW_ADD.type

SERVING = graph(services={SERVICE: TYPE})
CALLED_AT = START + 0.3
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
    calls = tuple(Call(given, until, cpu_wait_s) for given in called or (answer(),))
    return SingleCalls(trace(graph=SERVING, logs=logs), calls, **more)


def idle_run(logs: Sequence[LogRecord], **more: Any) -> IdleRun:
    return IdleRun(trace(graph=SERVING, logs=logs), series_in(logs), **more)


SUMS = (1005, 2005, 3005)
"""The right sums of three concurrent calls."""


def concurrent(
    *sums: int | None, took_s: Sequence[float] = (3.0, 3.0, 3.0), cpu_wait_s: float = 0.0
) -> ConcurrentCalls:
    """One batch of three concurrent calls with these sums; None means that a call was not answered."""
    answers = tuple(answer(took, 1000 * n, 5, sum_) for n, (took, sum_) in enumerate(zip(took_s, sums, strict=True), 1))
    return ConcurrentCalls(trace(graph=SERVING), (CallBatch(answers, cpu_wait_s),))


def assert_told(verdict: Verdict | None, told: str, *words: str) -> None:
    """Fail unless the verdict is "passed", or "undecided", or failed for this reason, with these words."""
    if told == "undecided":
        assert verdict is not None
        assert_undecided(verdict)
    elif told == "passed":
        assert_passed(verdict)
    else:
        assert_failed(verdict, told, *words)
