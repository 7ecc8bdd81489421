"""Random values are never called a pattern; patterns always are.

    python -m tests.judge.test_randomness [TRIALS]

draws each kind of random values a hundred thousand times, and counts how often it looks like a pattern.
"""

from __future__ import annotations

import math
import random
import sys
from collections import Counter
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tutor.judge.randomness import (
    COARSE_SAMPLE_SIZE,
    FULL_SAMPLE_SIZE,
    MIN_SAMPLE_SIZE,
    are_all_constant,
    are_coarse,
    find_pattern,
    may_be_one_sequence,
    needs_more_values,
)

TRIALS = 500
FEWER_TRIALS = 150
"""Enough where a fault would show in many of them."""

SEED = 20260101
rng = random.Random(SEED)


@pytest.fixture(autouse=True)
def seeded_rng() -> None:
    """Let each test draw the same values, whichever ran before it."""
    rng.seed(SEED)


def independent(draw: Callable[[], float]) -> Callable[[int], list[float]]:
    return lambda count: [draw() for _ in range(count)]


def walk(step: Callable[[], float], low: float = 20.0, high: float = 30.0) -> Callable[[int], list[float]]:
    def values(count: int) -> list[float]:
        value, walked = rng.uniform(22, 28), []
        for _ in range(count):
            value = min(high, max(low, value + step()))
            walked.append(value)
        return walked

    return values


def smoothed(count: int) -> list[float]:
    """A quickly varying value as a slow sensor shows it."""
    value, shown = 25.0, []
    for _ in range(count):
        value = 0.8 * value + 0.2 * rng.uniform(20, 30)
        shown.append(value)
    return shown


def noisy(curve: Callable[[int], float]) -> Callable[[int], list[float]]:
    return lambda count: [curve(i) + rng.uniform(-0.5, 0.5) for i in range(count)]


HUNDRED = [rng.uniform(20, 30) for _ in range(100)]

RANDOM = {
    "uniform": independent(lambda: rng.uniform(20, 30)),
    "two decimals": independent(lambda: round(rng.uniform(20, 30), 2)),
    "whole degrees": independent(lambda: float(rng.randint(20, 30))),
    "three values": independent(lambda: rng.choice([20.0, 25.0, 30.0])),
    "heads or tails": independent(lambda: rng.choice([20.0, 30.0])),
    "a list of 100": independent(lambda: rng.choice(HUNDRED)),
    "a list of 20": independent(lambda: rng.choice(HUNDRED[:20])),
    "one decimal": independent(lambda: round(rng.uniform(20, 30), 1)),
    "half degrees": independent(lambda: rng.randrange(40, 61) / 2),
    "clipped gauss": independent(lambda: min(30.0, max(20.0, rng.gauss(25, 4)))),
    "triangular": independent(lambda: rng.triangular(20, 30)),
    "nearly the same": independent(lambda: 25 + rng.uniform(-0.01, 0.01)),
    "smoothed": smoothed,
    "gauss": independent(lambda: rng.gauss(25, 1.5)),
    "walk": walk(lambda: rng.uniform(-0.5, 0.5)),
    "walk in equal steps": walk(lambda: rng.choice([-0.5, 0.5])),
    "walk in equal steps, or none": walk(lambda: rng.choice([-0.5, 0.0, 0.5])),
    "walk without walls": walk(lambda: rng.gauss(0, 0.1), -1e9, 1e9),
    "noise on a sine": noisy(lambda i: 25 + 4 * math.sin(i / 5)),
    "noise on a slow ramp": noisy(lambda i: 22 + 0.1 * i),
}

REPEATING = {
    "whole degrees", "three values", "heads or tails", "a list of 20", "half degrees", "walk", "walk in equal steps",
    "walk in equal steps, or none", "noise on a sine", "noise on a slow ramp",
}  # fmt: skip
"""The kinds that come close to a pattern now and then: most of their values occur twice, or follow a curve."""


@pytest.mark.parametrize("name", RANDOM)
def test_random_values_are_no_pattern(name: str) -> None:
    trials = TRIALS if name in REPEATING else FEWER_TRIALS
    found = [find_pattern(RANDOM[name](FULL_SAMPLE_SIZE)) for _ in range(trials)]
    assert not [each for each in found if each is not None]


@pytest.mark.parametrize("name", ["uniform", "two decimals", "whole degrees", "a list of 20", "gauss"])
@pytest.mark.parametrize("count", [MIN_SAMPLE_SIZE, 14])
def test_few_random_values_are_no_pattern(name: str, count: int) -> None:
    found = [find_pattern(RANDOM[name](count)) for _ in range(FEWER_TRIALS)]
    assert not [each for each in found if each is not None]


def test_random_values_rarely_need_more_values() -> None:
    doubtful = sum(needs_more_values(RANDOM["uniform"](MIN_SAMPLE_SIZE)) for _ in range(TRIALS))
    assert doubtful <= TRIALS / 20


@pytest.mark.parametrize("name", ["whole degrees", "half degrees"])
def test_coarse_random_values_need_only_a_few_more(name: str) -> None:
    samples = [RANDOM[name](COARSE_SAMPLE_SIZE) for _ in range(FEWER_TRIALS)]
    coarse = [values for values in samples if are_coarse(values)]
    assert len(coarse) > FEWER_TRIALS / 2
    assert sum(map(needs_more_values, coarse)) <= FEWER_TRIALS / 5


@pytest.mark.parametrize("period", range(2, 11))
def test_a_cycle_with_values_that_occur_twice_in_it_needs_more(period: int) -> None:
    missed = 0
    for _ in range(FEWER_TRIALS):
        cycle = [float(rng.randint(20, 30)) for _ in range(period - 1)]
        cycle.append(rng.choice(cycle))
        missed += not needs_more_values((cycle * 6)[:COARSE_SAMPLE_SIZE])
    assert missed == 0


def test_values_that_became_stuck_need_more() -> None:
    for _ in range(TRIALS):
        values = [float(rng.randint(20, 30)) for _ in range(rng.randint(3, FULL_SAMPLE_SIZE - 3))]
        assert needs_more_values([*values, values[-1]])


def test_runs_of_a_fixed_list_are_one_sequence_even_if_the_first_values_of_one_were_missed() -> None:
    listed = [float(rng.randint(20, 30)) for _ in range(FULL_SAMPLE_SIZE)]
    for missed in range(4):
        assert may_be_one_sequence(listed[:COARSE_SAMPLE_SIZE], listed[missed:COARSE_SAMPLE_SIZE])
        assert may_be_one_sequence(listed[missed:COARSE_SAMPLE_SIZE], listed[:COARSE_SAMPLE_SIZE])


def test_a_shuffled_list_of_different_values_is_one_sequence() -> None:
    listed = [20.0 + i for i in range(MIN_SAMPLE_SIZE)]
    assert may_be_one_sequence(rng.sample(listed, len(listed)), rng.sample(listed, len(listed)))


@pytest.mark.parametrize("name", ["uniform", "whole degrees"])
def test_two_random_runs_are_rarely_one_sequence(name: str) -> None:
    alike = sum(
        may_be_one_sequence(RANDOM[name](COARSE_SAMPLE_SIZE), RANDOM[name](COARSE_SAMPLE_SIZE)) for _ in range(TRIALS)
    )
    assert alike <= TRIALS / 20
    assert not may_be_one_sequence(RANDOM[name](MIN_SAMPLE_SIZE), [])


bases = st.floats(-100, 100)
counts = st.integers(10, FULL_SAMPLE_SIZE)


@given(bases, st.integers(3, 100))
def test_a_constant_is_found(value: float, count: int) -> None:
    found = find_pattern([value] * count)
    assert found is not None
    assert found.name == "constant value"
    assert needs_more_values([value] * count)


@given(bases, st.floats(1e-6, 50), st.booleans(), counts)
def test_a_ramp_is_found(start: float, step: float, down: bool, count: int) -> None:
    values = [start + (-step if down else step) * i for i in range(count)]
    found = find_pattern(values)
    assert found is not None
    assert found.name == "ramp"
    assert needs_more_values(values[:MIN_SAMPLE_SIZE])


@given(bases, st.floats(0.1, 10 / 3.1), st.booleans())
def test_a_sawtooth_is_found(start: float, step: float, down: bool) -> None:
    sign = -1 if down else 1
    values = [20 + sign * ((start + step * i) % 10) for i in range(FULL_SAMPLE_SIZE)]
    found = find_pattern(values)
    assert found is not None
    assert found.name in ("ramp", "short cycle")
    assert needs_more_values(values[:MIN_SAMPLE_SIZE])


@pytest.mark.parametrize("decimals", [1, 2, 9])
def test_a_ramp_that_starts_over_is_found_whatever_its_step(decimals: int) -> None:
    for _ in range(200):
        start, step = rng.uniform(0, 10), rng.uniform(0.3, 9.7)
        values = [round(20 + (start + i * step) % 10, decimals) for i in range(FULL_SAMPLE_SIZE)]
        assert needs_more_values(values[:MIN_SAMPLE_SIZE]), (start, step)
        assert find_pattern(values) is not None or decimals == 1, (start, step)


def test_a_ramp_of_two_or_three_alternating_steps_is_found() -> None:
    for period in (2, 3):
        for _ in range(200):
            steps = [rng.uniform(0.3, 9.7) for _ in range(period)]
            values = [rng.uniform(20, 30)]
            while len(values) < FULL_SAMPLE_SIZE:
                values.append(20 + (values[-1] - 20 + steps[len(values) % period]) % 10)
            assert needs_more_values(values[:MIN_SAMPLE_SIZE]), steps
            assert find_pattern(values) is not None, steps


def test_a_zigzag_is_found_though_each_value_comes_twice() -> None:
    zigzag = [20.0 + abs(number % 20 - 10) for number in range(30)]
    for values in (zigzag, [value for value in zigzag for _ in range(2)][:50]):
        found = find_pattern(values)
        assert found is not None
        assert (found.name, found.significant) == ("ramp", False)


def test_a_ramp_computed_from_the_clock_is_found() -> None:
    for _ in range(200):
        speed = rng.uniform(0.3, 3)
        times = [i + rng.uniform(-0.003, 0.003) for i in range(FULL_SAMPLE_SIZE)]
        assert find_pattern([20 + (speed * time) % 10 for time in times]) is not None, speed


def test_a_triangle_is_found() -> None:
    missed = 0
    for _ in range(200):
        start, step = rng.uniform(0, 10), rng.uniform(0.3, 9.7)
        missed += find_pattern([20 + abs((start + i * step) % 20 - 10) for i in range(FULL_SAMPLE_SIZE)]) is None
    assert missed <= 10  # with so few values, it may not reach its turning points


def test_a_cycle_after_a_different_first_value_is_found() -> None:
    values = [22.7] + [20.0, 22.1, 24.2, 26.3, 28.4, 30.0] * 4
    found = find_pattern(values)
    assert found is not None
    assert found.name == "short cycle"


def test_a_cycle_with_a_little_noise_is_found() -> None:
    values = [(21.3, 28.8, 24.1)[i % 3] + rng.uniform(-0.01, 0.01) for i in range(FULL_SAMPLE_SIZE)]
    assert find_pattern(values) is not None
    assert needs_more_values(values[:MIN_SAMPLE_SIZE])


@given(st.data())
def test_a_cycle_is_found(data: st.DataObject) -> None:
    period = data.draw(st.integers(2, 10))
    values = data.draw(st.lists(st.floats(20, 30), min_size=period, max_size=period, unique=True))
    found = find_pattern([values[i % period] for i in range(FULL_SAMPLE_SIZE)])
    assert found is not None
    assert found.name in ("short cycle", "ramp", "not random")


@pytest.mark.parametrize("step", [0.25, 0.5, 1.0, 2.0, 2.5, 5.0])
@pytest.mark.parametrize("start", [20.0, 25.0])
def test_bouncing_between_the_limits_is_found(step: float, start: float) -> None:
    values = [start]
    while len(values) < FULL_SAMPLE_SIZE:
        step = -step if not 20 <= values[-1] + step <= 30 else step
        values.append(values[-1] + step)
    assert find_pattern(values) is not None
    assert needs_more_values(values[:MIN_SAMPLE_SIZE])


@pytest.mark.parametrize("jitter", [0.0, 0.002])
def test_a_sine_is_found_even_with_timer_jitter(jitter: float) -> None:
    for _ in range(FEWER_TRIALS):
        omega, phase, size = rng.uniform(0.05, 1.5), rng.uniform(0, 7), rng.uniform(1, 5)
        times = [i + rng.uniform(-jitter, jitter) for i in range(FULL_SAMPLE_SIZE)]
        values = [25 + size * math.sin(omega * t + phase) for t in times]
        assert find_pattern(values) is not None, (omega, phase, size)
        assert needs_more_values(values[:MIN_SAMPLE_SIZE]), (omega, phase, size)


@given(st.floats(0.3, 0.99), st.floats(1, 10))
def test_a_decay_is_found(factor: float, size: float) -> None:
    assert find_pattern([20 + size * factor**i for i in range(FULL_SAMPLE_SIZE)]) is not None


@given(st.lists(st.floats(), max_size=2))
def test_two_values_are_no_pattern(values: list[float]) -> None:
    assert find_pattern(values) is None
    assert needs_more_values(values)


@given(
    st.lists(st.floats(), max_size=FULL_SAMPLE_SIZE) | st.lists(st.sampled_from([0.0, 1e-323, 5e-324, math.nan, 20.0]))
)
def test_any_values_can_be_judged(values: list[float]) -> None:
    find_pattern(values)
    needs_more_values(values)


def test_nan_and_inf_neither_make_a_pattern_nor_hide_one() -> None:
    lost = [math.nan, math.inf, -math.inf]
    for trial in range(200):
        rng = random.Random(trial)
        values = [rng.choice(lost) if i % 3 == 2 else rng.uniform(20, 30) for i in range(FULL_SAMPLE_SIZE)]
        assert find_pattern(values) is None
    ramp = [math.nan if i % 5 == 4 else 20 + i / 10 for i in range(FULL_SAMPLE_SIZE)]
    assert find_pattern(ramp) is not None
    assert find_pattern([20.0, math.nan] * 12) is not None
    assert find_pattern([math.nan] * 8) is not None
    assert needs_more_values([math.nan] * 4 + [21.5, 27.25, 24.0, 29.1])


def test_ints_sent_as_the_bits_of_a_float_still_vary() -> None:
    # What an int in a float field looks like on the wire: denormal numbers, smaller than any rounding.
    values = [rng.randint(20, 30) * 5e-324 for _ in range(FULL_SAMPLE_SIZE)]
    assert find_pattern(values) is None


def main() -> None:
    trials = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
    for name, draw in RANDOM.items():
        for count in (MIN_SAMPLE_SIZE, 14, FULL_SAMPLE_SIZE):
            found = Counter(
                each.name for _ in range(trials) if (each := find_pattern(draw(count))) is not None and each.significant
            )
            print(f"{name}, {count} values: {sum(found.values())} of {trials} {dict(found)}", flush=True)


if __name__ == "__main__":
    main()


@pytest.mark.parametrize(
    ("runs", "expected"),
    [
        ([[5.0] * 7, [6.0] * 7, [5.0] * 60], True),
        ([[5.0] * 7, [6.0] * 6, [5.0] * 60], False),
        ([[5.0] * 60, [], [5.0]], False),
        ([[5.0] * 30, [5.0] * 30], True),
        ([[5.0] * 30, [5.0] * 30, [5.0, 6.0]], False),
    ],
)
def test_several_constant_runs_are_evidence_together(runs: list[list[float]], expected: bool) -> None:
    assert are_all_constant(runs) is expected
