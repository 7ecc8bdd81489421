"""The form of a topic that keeps its rate during a call of a service that asks another one, judged on made-up facts."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from tests.checks.builders import CRASHED, START, assert_failed, assert_passed, judge_of, samples, trace
from tests.exercise.askings import CHECK, RIGHT, call
from tutor.exercise.keeps_pace_while_asking import Pace, PaceRun, measure_pace
from tutor.judge.rates import measure
from tutor.judge.verdict import Status, Undecided


def pace_run(pace: Pace | None, hz: float = 10.0, **more: Any) -> PaceRun:
    found = samples("/lamp", hz)
    return PaceRun(trace(*found), rate=measure(found), messages=len(found), calls=(RIGHT,), pace=pace, **more)


@pytest.mark.parametrize(
    ("pace", "right"),
    [
        (Pace(15, 1.5, 0.11), True),
        (Pace(12, 1.5, 0.4), True),
        (Pace(0, 1.5, 1.6), False),
        (Pace(15, 1.5, 0.9), False),
        (Pace(8, 1.5, 0.2), False),
        (Pace(30, 1.5, 0.05), False),
    ],
)
def test_the_pace_while_it_waits(pace: Pace, right: bool) -> None:
    judge = judge_of(CHECK, "pace")
    verdict = judge(pace_run(pace))
    if right:
        assert_passed(verdict)
    else:
        assert_failed(verdict, "callbacks wait for each other", "during a call", check=CHECK)
        assert isinstance(judge(pace_run(replace(pace, cpu_wait_s=1.2))), Undecided)


def paced(start_s: float, end_s: float, hz: float = 10.0) -> list[float]:
    """Source times of messages at this rate."""
    return [START + start_s + i / hz for i in range(int((end_s - start_s) * hz))]


@pytest.mark.parametrize(
    ("took_s", "asked_s", "pause", "words"),
    [
        (1.55, 0.0, None, None),
        (1.55, 0.0, (0.0, 1.5), "stops while /cook waits for a reply"),
        (1.6, 0.0, (-0.3, 1.6), "stops while /cook waits for a reply"),
        (2.6, 1.0, (0.0, 1.0), "stops before /cook asks /oven"),
        (3.5, 0.0, (1.5, 3.5), "stops after /oven has replied"),
        (3.5, 0.0, (1.5, 5.0), "stops after /oven has replied"),
    ],
)
def test_a_topic_may_pause_in_any_part_of_a_call(
    took_s: float, asked_s: float, pause: tuple[float, float] | None, words: str | None
) -> None:
    start, end = pause or (0.0, 0.0)
    times = [at for at in paced(-1.0, took_s + 0.5) if not START + start < at < START + end]
    answer = replace(RIGHT.answer, answered_at=START + took_s)
    pace = measure_pace(times, answer, START + asked_s, START + asked_s + 1.5)
    verdict = judge_of(CHECK, "pace")(pace_run(pace))
    if words is None:
        assert_passed(verdict)
    else:
        assert_failed(verdict, "callbacks wait for each other", words, check=CHECK)


def test_without_an_answer_the_pace_counts_until_the_reply() -> None:
    lost = replace(RIGHT.answer, response=None, answered_at=START + 6.5)
    assert measure_pace(paced(-1.0, 1.6), lost, START, START + 1.5).is_right(10.0)
    silent = measure_pace([], lost, START, START + 1.5)
    assert (silent.count, silent.longest_s, silent.pauses) == (0, 1.5, "while it waits")


def test_a_wrong_pace_without_a_pause_is_no_standstill() -> None:
    verdict = judge_of(CHECK, "pace")(pace_run(Pace(8, 1.5, 0.2)))
    assert_failed(verdict, "callbacks wait for each other", "does not keep its rate while /cook waits", check=CHECK)


def test_a_short_wait_for_a_cpu_explains_no_long_pause() -> None:
    assert_failed(
        judge_of(CHECK, "pace")(pace_run(Pace(0, 1.5, 1.6, cpu_wait_s=0.3))),
        "callbacks wait for each other",
        check=CHECK,
    )


def test_a_pace_that_cannot_be_judged() -> None:
    judge = judge_of(CHECK, "pace")
    assert_failed(judge(PaceRun(trace())), "no publisher", "no message", check=CHECK)
    assert_failed(judge(pace_run(None, hz=5.0)), "wrong rate", "while nobody calls: 5.00 Hz", check=CHECK)
    assert judge(replace(pace_run(None), calls=())).status is Status.SKIPPED
    assert judge(pace_run(None)).status is Status.SKIPPED
    waits = replace(pace_run(None), calls=(call(True),))
    assert_failed(judge(waits), "no answer", "was not asked", check=CHECK)
    ended = replace(pace_run(Pace(15, 1.5, 0.1)), trace=CRASHED)
    assert_failed(judge(ended), "unhandled exception", "then the process ended", check=CHECK)
