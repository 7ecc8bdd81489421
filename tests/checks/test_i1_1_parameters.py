"""I1.1: verdicts on fabricated rates and names of a thermometer."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from checks.i1_1_sensor_publisher import CHECK
from tests.checks.builders import (
    CRASHED,
    NO_NODE,
    assert_passed,
    graph,
    judge_of,
    log,
    parameter,
    rate,
    trace,
)
from tests.checks.thermometer import MESSAGES, PUBLISHING, assert_failed
from tutor.exercise.logs_parameter import NameProbe, NameProbes
from tutor.exercise.rate_units import UNITS, RateProbe, RateProbes, are_inverted, possible_units
from tutor.judge.rates import Rate
from tutor.judge.trace import Trace
from tutor.ros_model import Parameter

judge_rate = judge_of(CHECK, "rate")
judge_name = judge_of(CHECK, "sensor-name")

RATE = parameter("publish_rate", "double", 1.0)
RATES_HZ = (2.0, 8.0, 0.7)


def probe(
    value: float, hz: float | None, name: str = "publish_rate", unit: str = "Hz", seen: Trace | None = None
) -> RateProbe:
    measured = None if hz is None else rate(hz)
    return RateProbe(name, unit, value, measured, 10 if hz else 0, seen or trace(*MESSAGES, graph=PUBLISHING))


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
    right = [probe(UNITS[unit](rate_hz), rate_hz, "period", unit) for rate_hz in hz]
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
