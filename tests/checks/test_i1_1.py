"""I1.1: verdicts on fabricated starts, values, rates and names."""

from __future__ import annotations

import random
from dataclasses import replace
from functools import partial
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from checks.i1_1_sensor_publisher import CHECK, TEMPERATURE
from tests.checks import builders
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
    graph,
    judge_of,
    log,
    parameter,
    sample,
    samples,
    trace,
)
from tutor.exercise.collected_values import CollectedValues
from tutor.exercise.logs_parameter import NameProbe, NameProbes
from tutor.exercise.publishing_start import MATCHED_S, PublishingRun
from tutor.exercise.rate_units import UNITS, RateProbe, RateProbes, are_inverted, possible_units
from tutor.judge.rates import Rate
from tutor.judge.trace import Echo, Trace
from tutor.ros_model import Parameter, QoS, TopicEndpoint

TOPIC, TYPE = TEMPERATURE.name, TEMPERATURE.type

assert_failed = partial(builders.assert_failed, check=CHECK)

judge_publishes = judge_of(CHECK, "publishes")
judge_range, judge_range_so_far = judge_of(CHECK, "range"), early_judge_of(CHECK, "range")
judge_random = judge_of(CHECK, "random")
judge_echo = judge_of(CHECK, "echo")
judge_rate = judge_of(CHECK, "rate")
judge_name = judge_of(CHECK, "sensor-name")
judge_shutdown = judge_of(CHECK, "shutdown")

PUBLISHING = graph(publishers={TOPIC: TYPE})
MESSAGES = samples(TOPIC, 2.0, data=23.5)


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
    assert builders.explained(verdict, CHECK).mistake in ("out-of-range", "int-in-a-float-field")


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


RATE = parameter("publish_rate", "double", 1.0)
RATES_HZ = (2.0, 8.0, 0.7)


def probe(
    value: float, hz: float | None, name: str = "publish_rate", unit: str = "Hz", seen: Trace | None = None
) -> RateProbe:
    rate = None if hz is None else Rate(hz, 10, 9 / hz)
    return RateProbe(name, unit, value, rate, 10 if hz else 0, seen or trace(*MESSAGES, graph=PUBLISHING))


def rates(*probes: RateProbe, declared: tuple[Parameter, ...] | None = (RATE,)) -> RateProbes:
    return RateProbes(declared, probes)


@given(st.lists(st.floats(0.81, 1.19), min_size=3, max_size=3))
def test_rates_within_20_percent_pass(factors: list[float]) -> None:
    found = [probe(hz, hz * factor) for hz, factor in zip(RATES_HZ, factors, strict=True)]
    assert_passed(judge_rate(rates(*found)))


@pytest.mark.parametrize(
    ("declared", "services", "spins"),
    [((RATE,), True, True), (None, True, False), (None, False, None)],
)
def test_rate_says_whether_the_node_spins(declared: Any, services: bool, spins: bool | None) -> None:
    asked = {"/node/list_parameters": "rcl_interfaces/srv/ListParameters"} if services else {}
    found = [probe(hz, hz, seen=trace(graph=graph(services=asked))) for hz in RATES_HZ]
    verdict = judge_rate(rates(*found, declared=declared))
    assert_passed(verdict)
    assert verdict.spins is spins


@given(st.sampled_from(range(3)), st.floats(0.01, 0.79) | st.floats(1.21, 100))
def test_one_rate_off_by_more_than_20_percent_fails(which: int, factor: float) -> None:
    found = [probe(hz, hz * (factor if i == which else 1)) for i, hz in enumerate(RATES_HZ)]
    assert not judge_rate(rates(*found)).passed


@given(st.sampled_from(["s", "ms"]), st.permutations(RATES_HZ))
def test_a_period_parameter_passes_like_a_rate(unit: str, hz: list[float]) -> None:
    right = [probe(UNITS[unit](each), each, "period", unit) for each in hz]
    assert_passed(judge_rate(rates(*right, declared=(parameter("period", "double", 1.0),))))


def test_one_working_parameter_of_several_is_enough() -> None:
    right = [probe(hz, hz, "tick") for hz in RATES_HZ]
    wrong = [probe(hz, 1.0, "noise") for hz in RATES_HZ]
    assert_passed(judge_rate(rates(*wrong, *right)))


def test_a_period_is_explained_in_the_unit_that_its_name_ends_with() -> None:
    probes = [probe(UNITS[unit](hz), 50.0, "period_ms", unit) for unit in ("s", "ms") for hz in RATES_HZ]
    declared = (parameter("period_ms", "integer", 1000),)
    assert_failed(judge_rate(rates(*probes, declared=declared)), "parameter ignored", "period_ms:=500 asks for 2 Hz")


BOTH = (parameter("period", "double", 1.0), RATE)


def test_a_parameter_named_after_the_rate_is_explained_even_if_another_agrees_once_by_chance() -> None:
    by_chance = [probe(0.5, 2.0, "min_temp", "s"), probe(1.5, 2.0, "min_temp", "s")]
    inverted = [probe(hz, 1 / hz) for hz in RATES_HZ]
    declared = (RATE, parameter("min_temp", "double", 20.0))
    assert_failed(judge_rate(rates(*by_chance, *inverted, declared=declared)), "rate used as a period", "publish_rate")


def test_rates_are_inverted_if_all_that_could_be_measured_are() -> None:
    inverted = [probe(2.0, 0.5), probe(0.7, 1 / 0.7), probe(10.0, None)]
    assert are_inverted(inverted, min_measured=2)
    assert not are_inverted(inverted[1:], min_measured=2)
    assert not are_inverted([*inverted, probe(8.0, 8.0)])
    assert not are_inverted([probe(10.0, None)])


@pytest.mark.parametrize(
    ("found", "cause", "word"),
    [
        (rates(declared=()), "parameter not declared", "no numeric parameter"),
        (rates(declared=None), "parameter not declared", "publish_rate"),
        (rates(*(probe(hz, 1.0) for hz in RATES_HZ), declared=()), "parameter not declared", ""),
        (rates(*(probe(hz, 1 / hz) for hz in RATES_HZ)), "rate used as a period", "waits that many seconds"),
        (rates(*(probe(v, v, "period", "s") for v in (0.5, 0.125, 1.5)), declared=BOTH), "period used as a rate", ""),
        (rates(*(probe(hz, 1.0) for hz in RATES_HZ)), "parameter ignored", "1.00 Hz"),
        (rates(*(probe(hz, 1.1 if hz > 1 else 1.0) for hz in RATES_HZ)), "parameter ignored", ""),
        (rates(*(probe(hz, hz * 2) for hz in RATES_HZ)), "wrong rate", "4.00 Hz"),
        (rates(probe(2, 2), probe(8, 5), probe(0.7, 0.7)), "wrong rate", "8 Hz"),
        (rates(probe(2, None), probe(8, None)), "wrong rate", "no message"),
        (rates(probe(2, None, seen=CRASHED), probe(8, None, seen=CRASHED)), "unhandled exception", "line 12"),
        (rates(probe(2, 2)), "good value refused", "only one of the rates"),
    ],
)
def test_rate_fails(found: RateProbes, cause: str, word: str) -> None:
    assert_failed(judge_rate(found), cause, word)


LEFT_OVER = """\
from rclpy.node import Node
class Thermometer(Node):
    def __init__(self):
        super().__init__("thermometer")
        self.declare_parameter("publish_rate", 1.0)
        self.timer = self.create_timer(0.5, self.tick)
        self.timer = self.create_timer(1.0 / self.get_parameter("publish_rate").value, self.tick)
"""


def test_messages_in_bursts_are_explained_by_a_timer_that_is_left_over() -> None:
    seen = trace(*MESSAGES, graph=PUBLISHING, sources={"node.py": LEFT_OVER})
    in_bursts = [replace(probe(hz, hz, seen=seen), rate=Rate(hz, 20, 19 / hz, 0.1 / hz)) for hz in RATES_HZ]
    assert_failed(judge_rate(rates(*in_bursts)), "two timers", "line 6")


def test_the_nearest_parameter_is_the_one_explained() -> None:
    noise = [probe(hz, 1.0, "a_noise") for hz in RATES_HZ]
    near = [probe(hz, 1 / hz, "z_rate") for hz in RATES_HZ]
    declared = (parameter("a_noise", "double", 1.0), parameter("z_rate", "double", 1.0))
    assert_failed(judge_rate(rates(*noise, *near, declared=declared)), "rate used as a period", "z_rate")


@pytest.mark.parametrize(
    ("name", "read_as"),
    [
        ("publish_rate", ("Hz",)),
        ("HZ", ("Hz",)),
        ("frequency", ("Hz",)),
        ("timer_period", ("s", "ms")),
        ("interval_ms", ("s", "ms")),
        ("rate_period", ("Hz", "s", "ms")),
        ("speed", ("Hz", "s", "ms")),
    ],
)
def test_units_suggested_by_a_parameter_name(name: str, read_as: tuple[str, ...]) -> None:
    assert possible_units(name) == read_as


NAME = parameter("sensor_name", "string", "s")
TOKEN = "probe_0_kx7"


def names(*probes: NameProbe, declared: tuple[Parameter, ...] | None = (NAME,)) -> NameProbes:
    return NameProbes(declared, probes)


def name_probe(found: str = "", seen: Trace | None = None, name: str = "sensor_name") -> NameProbe:
    return NameProbe(name, TOKEN, found, seen or trace(logs=[log("25.0 °C")]))


@pytest.mark.parametrize(
    "found",
    [
        names(name_probe(f"[INFO] [node]: {TOKEN}: 25")),
        names(name_probe(), name_probe(f"[DEBUG] [node]: {TOKEN}", name="label")),
        names(name_probe(f"[INFO] [node]: {TOKEN}"), declared=None),
    ],
)
def test_name_passes(found: NameProbes) -> None:
    assert_passed(judge_name(found))


@pytest.mark.parametrize(
    ("found", "cause"),
    [
        (names(name_probe(), declared=()), "parameter not declared"),
        (names(name_probe(), declared=(RATE,)), "parameter not declared"),
        (names(name_probe(), declared=None), "parameter not declared"),
        (names(name_probe(seen=CRASHED), declared=None), "unhandled exception"),
        (names(name_probe()), "not logged"),
        (names(name_probe(seen=trace(out=f"{TOKEN}: 25.0"))), "printed, not logged"),
        (names(name_probe(), name_probe(seen=trace(err=f"{TOKEN}: 25.0"))), "printed, not logged"),
        (names(name_probe(seen=NO_NODE)), "no node"),
    ],
)
def test_name_fails(found: NameProbes, cause: str) -> None:
    assert_failed(judge_name(found), cause)


def test_shutdown() -> None:
    assert_passed(judge_shutdown(plain_start(trace(*MESSAGES), ending=ending(0))))
    assert_passed(judge_shutdown(plain_start(trace(*MESSAGES), ending=ending(signal=2))))
    unclean = plain_start(trace(*MESSAGES), ending=ending(1, err=KEYBOARD_INTERRUPT))
    assert_failed(judge_shutdown(unclean), "traceback on exit")
    assert_skipped(judge_shutdown(plain_start(CRASHED, ending=None)), "`publishes` shows why")


def test_the_first_message_is_shown_in_the_format_of_ros2_topic_echo() -> None:
    verdict = judge_publishes(plain_start(trace(*samples(TOPIC, 2.0, data=21.25))))
    assert verdict.evidence == ("data: 21.25",)
