"""Random values are never called a pattern; patterns always are."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tutor.judge.randomness import ENOUGH, PLENTY, pattern, suspicious

TRIALS = 500
MOST = 2
"""So many of the trials may look like a pattern by chance: far fewer than one in a thousand of them do."""

chance = random.Random(20260101)


def drawn(draw: Callable[[], float]) -> Callable[[int], list[float]]:
    return lambda count: [draw() for _ in range(count)]


def walk(step: Callable[[], float], low: float = 20.0, high: float = 30.0) -> Callable[[int], list[float]]:
    def values(count: int) -> list[float]:
        value, walked = chance.uniform(22, 28), []
        for _ in range(count):
            value = min(high, max(low, value + step()))
            walked.append(value)
        return walked

    return values


def noisy(curve: Callable[[int], float]) -> Callable[[int], list[float]]:
    return lambda count: [curve(i) + chance.uniform(-0.5, 0.5) for i in range(count)]


RANDOM = {
    "uniform": drawn(lambda: chance.uniform(20, 30)),
    "two decimals": drawn(lambda: round(chance.uniform(20, 30), 2)),
    "whole degrees": drawn(lambda: float(chance.randint(20, 30))),
    "three values": drawn(lambda: chance.choice([20.0, 25.0, 30.0])),
    "heads or tails": drawn(lambda: chance.choice([20.0, 30.0])),
    "gauss": drawn(lambda: chance.gauss(25, 1.5)),
    "walk": walk(lambda: chance.uniform(-0.5, 0.5)),
    "walk in equal steps": walk(lambda: chance.choice([-0.5, 0.5])),
    "walk in equal steps, or none": walk(lambda: chance.choice([-0.5, 0.0, 0.5])),
    "walk without walls": walk(lambda: chance.gauss(0, 0.1), -1e9, 1e9),
    "noise on a sine": noisy(lambda i: 25 + 4 * math.sin(i / 5)),
    "noise on a slow ramp": noisy(lambda i: 22 + 0.1 * i),
}


@pytest.mark.parametrize("name", RANDOM)
def test_random_values_are_no_pattern(name: str) -> None:
    found = [pattern(RANDOM[name](PLENTY)) for _ in range(TRIALS)]
    assert sum(each is not None for each in found) <= MOST, {each for each in found if each}


def test_random_values_hardly_ever_need_more_than_a_few() -> None:
    doubtful = sum(suspicious(RANDOM["uniform"](ENOUGH)) for _ in range(TRIALS))
    assert doubtful <= TRIALS / 20


bases = st.floats(-100, 100)
counts = st.integers(10, PLENTY)


@given(bases, st.integers(3, 100))
def test_a_constant_is_found(value: float, count: int) -> None:
    found = pattern([value] * count)
    assert found is not None
    assert found.name == "constant value"
    assert suspicious([value] * count)


@given(bases, st.floats(1e-6, 50), st.booleans(), counts)
def test_a_ramp_is_found(start: float, step: float, down: bool, count: int) -> None:
    values = [start + (-step if down else step) * i for i in range(count)]
    found = pattern(values)
    assert found is not None
    assert found.name == "ramp"
    assert suspicious(values[:ENOUGH])


@given(bases, st.floats(0.1, 10 / 3.1), st.booleans())
def test_a_sawtooth_is_found(start: float, step: float, down: bool) -> None:
    sign = -1 if down else 1
    values = [20 + sign * ((start + step * i) % 10) for i in range(PLENTY)]
    found = pattern(values)
    assert found is not None
    assert found.name in ("ramp", "short cycle")
    assert suspicious(values[:ENOUGH])


@given(st.data())
def test_a_cycle_is_found(data: st.DataObject) -> None:
    period = data.draw(st.integers(2, 10))
    values = data.draw(st.lists(st.floats(20, 30), min_size=period, max_size=period, unique=True))
    found = pattern([values[i % period] for i in range(PLENTY)])
    assert found is not None
    assert found.name in ("short cycle", "ramp", "not random")


@pytest.mark.parametrize("step", [0.25, 0.5, 1.0, 2.0, 2.5, 5.0])
@pytest.mark.parametrize("start", [20.0, 25.0])
def test_up_to_the_top_and_down_again_is_found(step: float, start: float) -> None:
    values = [start]
    while len(values) < PLENTY:
        step = -step if not 20 <= values[-1] + step <= 30 else step
        values.append(values[-1] + step)
    assert pattern(values) is not None
    assert suspicious(values[:ENOUGH])


@pytest.mark.parametrize("jitter", [0.0, 0.002])
def test_a_sine_is_found_also_with_a_timers_jitter(jitter: float) -> None:
    for _ in range(300):
        omega, phase, size = chance.uniform(0.05, 1.5), chance.uniform(0, 7), chance.uniform(1, 5)
        times = [i + chance.uniform(-jitter, jitter) for i in range(PLENTY)]
        values = [25 + size * math.sin(omega * t + phase) for t in times]
        assert pattern(values) is not None, (omega, phase, size)
        assert suspicious(values[:ENOUGH]), (omega, phase, size)


@given(st.floats(0.3, 0.99), st.floats(1, 10))
def test_a_decay_is_found(factor: float, size: float) -> None:
    assert pattern([20 + size * factor**i for i in range(PLENTY)]) is not None


@given(st.lists(st.floats(), max_size=2))
def test_two_values_tell_nothing(values: list[float]) -> None:
    assert pattern(values) is None
    assert suspicious(values)


@given(st.lists(st.floats(), max_size=PLENTY) | st.lists(st.sampled_from([0.0, 1e-323, 5e-324, math.nan, 20.0])))
def test_any_values_can_be_judged(values: list[float]) -> None:
    pattern(values)
    suspicious(values)


def test_ints_sent_as_the_bits_of_a_float_vary_all_the_same() -> None:
    # What an int in a float field looks like on the wire: numbers below any rounding.
    values = [chance.randint(20, 30) * 5e-324 for _ in range(PLENTY)]
    assert pattern(values) is None
