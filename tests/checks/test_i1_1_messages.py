"""I1.1: verdicts on fabricated starts and values of a thermometer."""

from __future__ import annotations

import random
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from checks.i1_1_sensor_publisher import CHECK
from tests.checks.builders import (
    CRASHED,
    KEYBOARD_INTERRUPT,
    NO_NODE,
    NODE_UP,
    START,
    assert_passed,
    assert_skipped,
    early_judge_of,
    ending,
    explained,
    graph,
    judge_of,
    sample,
    samples,
    trace,
)
from tests.checks.thermometer import MESSAGES, PUBLISHING, TOPIC, TYPE, assert_failed
from tutor.exercise import Publishes, Topic
from tutor.exercise.collected_values import CollectedValues
from tutor.exercise.publishing_start import MATCHED_S, PublishingRun
from tutor.judge.trace import Echo, Trace
from tutor.judge.verdict import Status
from tutor.ros_model import QoS, TopicEndpoint

judge_publishes = judge_of(CHECK, "publishes")
judge_range, judge_range_so_far = judge_of(CHECK, "range"), early_judge_of(CHECK, "range")
judge_random = judge_of(CHECK, "random")
judge_echo = judge_of(CHECK, "echo")
judge_shutdown = judge_of(CHECK, "shutdown")


def echo(*types: str, shown: bool = True) -> Echo:
    return Echo(TOPIC, types, QoS(), MESSAGES[:1] if shown else (), 14.0)


def plain_start(seen: Trace, **more: Any) -> PublishingRun:
    facts = {"parameters": (), "echo": echo(TYPE), "ending": ending(0), **more}
    return PublishingRun(TOPIC, seen, **facts)


@pytest.mark.parametrize("parameters", [None, ()])
@pytest.mark.parametrize("seen", [trace(*MESSAGES, graph=PUBLISHING), trace(*MESSAGES, graph=NODE_UP)])
def test_publishes_passes(seen: Trace, parameters: Any) -> None:
    assert_passed(judge_publishes(plain_start(seen, parameters=parameters)))


@pytest.mark.parametrize(
    ("seen", "parameters", "cause"),
    [
        (CRASHED, None, "unhandled exception"),
        (NO_NODE, None, "no node"),
        (trace(graph=PUBLISHING), None, "no spin"),
        (trace(graph=PUBLISHING), (), "no messages"),
        (trace(graph=graph(publishers={TOPIC: "std_msgs/msg/Int64"})), (), "wrong type"),
        (trace(graph=graph(publishers={"/sensor/temp": TYPE})), (), "wrong topic"),
        (trace(graph=NODE_UP), (), "no publisher"),
    ],
)
def test_publishes_fails(seen: Trace, parameters: Any, cause: str) -> None:
    assert_failed(judge_publishes(plain_start(seen, parameters=parameters)), cause)


@pytest.mark.parametrize(
    ("sent_s", "goes_on"),
    [
        ([0.1], False),
        ([0.1, 0.2, 0.3, 0.4, 0.5], False),
        ([3.0, 3.1, 3.2], False),  # after a long pause at the start
        ([0.1, 1.1, 2.1], False),  # whether the second one counts would be a race
        ([0.1, 6.0, 11.0], True),
        ([0.6, 1.1, 1.6, 2.1, 2.6], True),
    ],
)
@pytest.mark.parametrize("missed", [0, 1])
def test_publishes_does_not_depend_on_what_was_missed_at_the_start(
    sent_s: list[float], goes_on: bool, missed: int
) -> None:
    seen = trace(*(sample(TOPIC, 23.5, START + at) for at in sent_s[missed:]), graph=PUBLISHING)
    verdict = judge_publishes(plain_start(seen, counted_from=START + MATCHED_S))
    assert verdict.passed == goes_on


@pytest.mark.parametrize(
    ("sent_s", "cpu_wait_s", "status"),
    [
        ([0.5 * number for number in range(8)], 0.0, Status.PASSED),
        ([2.0, 2.48, 3.02], 0.0, Status.PASSED),
        ([0.25 * number for number in range(7)] + [2.5, 2.75, 3.0, 3.25], 0.0, Status.PASSED),  # with a pause
        ([burst + 0.01 * number for burst in range(6) for number in range(3)], 0.0, Status.PASSED),
        ([float(number) for number in range(6)], 0.0, Status.FAILED),
        ([2.0 * number for number in range(6)], 0.0, Status.FAILED),
        ([0.1 * number for number in range(10)] + [2.0, 3.0, 4.0, 5.0], 0.0, Status.FAILED),  # slower after its start
        ([0.1 * number for number in range(50)], 3.0, Status.PASSED),
        ([float(number) for number in range(6)], 0.5, Status.FAILED),
        ([float(number) for number in range(6)], 2.0, Status.ERROR),  # the machine may have slowed it down
    ],
)
def test_messages_come_often_enough(sent_s: list[float], cpu_wait_s: float, status: Status) -> None:
    seen = trace(*(sample(TOPIC, 23.5, START + at) for at in sent_s), graph=PUBLISHING)
    topic = Topic(TOPIC, TYPE)
    run = plain_start(seen, counted_from=START + MATCHED_S, cpu_wait_s=cpu_wait_s)
    verdict = Publishes("often", topic, 2.0).judge(run)
    assert verdict.status is status
    assert Publishes("at-all", topic).judge(run).passed
    if status is Status.FAILED:
        assert "a second" in verdict.observed


@given(st.lists(st.lists(st.floats(20, 30), min_size=1).map(tuple), min_size=1).map(tuple))
def test_range_passes(runs: tuple[tuple[float, ...], ...]) -> None:
    assert_passed(judge_range(CollectedValues(runs), CollectedValues(())))


@given(
    st.lists(st.floats(20, 30), max_size=5),
    st.floats().filter(lambda value: not 20 <= value <= 30),
    st.lists(st.floats(20, 30), max_size=5),
)
def test_one_value_outside_the_range_fails(before: list[float], outside: float, after: list[float]) -> None:
    verdict = judge_range(CollectedValues(((25.0,), (*before, outside, *after))), CollectedValues(()))
    assert not verdict.passed
    assert explained(verdict, CHECK).mistake in ("out-of-range", "int-in-a-float-field")


@pytest.mark.parametrize(
    ("values", "cause", "word"),
    [
        ((68.0, 75.5, 86.0), "out of range", "Fahrenheit"),
        ((25.0, 31.0), "out of range", "1 of 2 values"),
        ((25.0, 85.0, 26.0), "out of range", "1 of 3 values"),
        ((1.1e-322, 1.2e-322), "an int in a float field", "Python float"),
        ((0.0, 0.0), "out of range", "0"),
        ((float("nan"), 25.0), "out of range", "nan"),
        ((), "no messages", "no values"),
    ],
)
def test_range_fails(values: tuple[float, ...], cause: str, word: str) -> None:
    assert_failed(judge_range(CollectedValues((values, ())), CollectedValues(())), cause, word)


@given(st.lists(st.floats(), max_size=9).map(tuple))
def test_a_range_that_fails_so_far_fails_in_the_end(values: tuple[float, ...]) -> None:
    so_far = judge_range_so_far(CollectedValues((values,)))
    whole = judge_range(CollectedValues((values, (25.0,))), CollectedValues(()))
    assert so_far is None or so_far.passed or not values or not whole.passed


def test_two_values_are_too_few_to_diagnose_fahrenheit() -> None:
    assert judge_range_so_far(CollectedValues(((70.0, 75.0),))) is None
    assert_failed(judge_range_so_far(CollectedValues(((70.0, 75.0, 80.0),))), "out of range", "Fahrenheit")
    assert_failed(judge_range_so_far(CollectedValues(((35.0,),))), "out of range", "1 of 1 values outside")


def test_values_of_other_starts_count_too() -> None:
    verdict = judge_range(CollectedValues(((25.0,), (24.0,))), CollectedValues(((21.0, 19.5),)))
    assert_failed(verdict, "out of range", "1 of 4 values outside, such as 19.5")


def draw_values(count: int = 24) -> tuple[float, ...]:
    rng = random.Random(count)
    return tuple(rng.uniform(20, 30) for _ in range(count))


@pytest.mark.parametrize(
    "runs",
    [
        (draw_values(), draw_values(8)),
        (draw_values(8), ()),
        ((), draw_values(3)),
        (draw_values(8), draw_values(8)),
        (draw_values(3) + (25.0,) * 21, draw_values()),
        ((25.0, 26.0, 24.0) + (25.0,) * 21,) * 2,
    ],
)
def test_random_passes(runs: tuple[tuple[float, ...], ...]) -> None:
    assert_passed(judge_random(CollectedValues(runs)))


@pytest.mark.parametrize(
    ("runs", "cause"),
    [
        ((draw_values(), (25.0,) * 24), "constant value"),
        (((25.0,) * 24, draw_values()), "constant value"),
        ((tuple(20 + i / 4 for i in range(24)), draw_values()), "ramp"),
        ((tuple(20.0 + i % 7 for i in range(24)), draw_values()), "pattern in the values"),
        ((tuple(20.0 + i % 10 for i in range(10)),) * 2, "ramp"),
        ((draw_values(5) * 5, draw_values(5) * 5), "pattern in the values"),
        ((draw_values(3) + (25.0,) * 21,) * 2, "constant value"),
        ((draw_values(2), draw_values(1)), "no messages"),
        (((), ()), "no messages"),
    ],
)
def test_random_fails(runs: tuple[tuple[float, ...], ...], cause: str) -> None:
    assert_failed(judge_random(CollectedValues(runs)), cause)


def test_more_values_from_a_faster_start_reveal_a_pattern() -> None:
    few = (draw_values(9)[:3], draw_values(9)[:3])
    assert_passed(judge_random(CollectedValues(few)))
    assert_failed(judge_random(CollectedValues(few, regular=(21.5,) * 24)), "constant value")


def test_echo_passes() -> None:
    assert_passed(judge_echo(plain_start(trace(*MESSAGES), echo=echo(TYPE))))


@pytest.mark.parametrize(
    ("shown", "cause"),
    [
        (echo(TYPE, "std_msgs/msg/Float32"), "wrong type"),
        (echo(TYPE, "std_msgs/msg/Float32", shown=False), "wrong type"),
        (echo(shown=False), "no messages"),
        (echo(TYPE, shown=False), "no messages"),
        (None, "no messages"),
    ],
)
def test_echo_fails(shown: Echo | None, cause: str) -> None:
    assert_failed(judge_echo(plain_start(trace(*MESSAGES), echo=shown)), cause)


def test_echo_refuses_a_topic_to_which_another_type_subscribes() -> None:
    subscribed = replace(graph(), subscriptions=(TopicEndpoint(TOPIC, "std_msgs/msg/String", "/display"),))
    seen = plain_start(replace(trace(*MESSAGES), graph=subscribed), echo=echo(TYPE))
    assert_failed(judge_echo(seen), "wrong type", "std_msgs/msg/String")


def test_a_crash_is_the_cause_rather_than_a_missing_timer() -> None:
    assert_failed(judge_random(CollectedValues((draw_values(1), ()), CRASHED)), "unhandled exception")
    assert_failed(judge_echo(plain_start(CRASHED, echo=echo(shown=False))), "unhandled exception")
    assert_failed(judge_echo(plain_start(CRASHED, echo=None)), "unhandled exception")


def test_shutdown() -> None:
    assert_passed(judge_shutdown(plain_start(trace(*MESSAGES), ending=ending(0))))
    assert_passed(judge_shutdown(plain_start(trace(*MESSAGES), ending=ending(signal=2))))
    unclean = plain_start(trace(*MESSAGES), ending=ending(1, err=KEYBOARD_INTERRUPT))
    assert_failed(judge_shutdown(unclean), "traceback on exit")
    assert_skipped(judge_shutdown(plain_start(CRASHED, ending=None)), "`publishes` shows why")


def test_the_first_message_is_shown_in_the_format_of_ros2_topic_echo() -> None:
    verdict = judge_publishes(plain_start(trace(*samples(TOPIC, 2.0, data=21.25))))
    assert verdict.evidence == ("data: 21.25",)
