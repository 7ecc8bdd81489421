"""Rates are measured from source timestamps, in whatever order the messages arrived."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.checks.builders import sample, samples
from tutor.judge.rates import MIN_EVEN, MIN_FOR_BURSTS, TOLERANCE, Rate, are_even, describe, measure
from tutor.judge.trace import Sample
from tutor.judge.waiting_for_nodes import REMEASURE_S, measure_steady_rate, too_few_by_cpu_wait, window_s

rates = st.floats(0.05, 1000)


@given(rates, st.integers(2, 60), st.integers())
def test_a_steady_rate_is_measured_exactly(hz: float, count: int, seed: int) -> None:
    received = list(samples("/t", hz, count=count))
    random.Random(seed).shuffle(received)
    rate = measure(received)
    assert rate is not None
    assert rate.samples == count
    assert rate.hz == pytest.approx(hz, rel=1e-6)
    assert rate.span_s == pytest.approx((count - 1) / hz, rel=1e-6)


@given(rates, st.floats(0.01, 3))
def test_a_rate_agrees_within_its_tolerance(asked: float, factor: float) -> None:
    inside, outside = factor < 1 + TOLERANCE - 1e-9, factor > 1 + TOLERANCE + 1e-9
    inside, outside = inside and factor > 1 - TOLERANCE + 1e-9, outside or factor < 1 - TOLERANCE - 1e-9
    agrees = Rate(asked * factor, 10, 1.0).agrees_with(asked)
    assert not inside or agrees
    assert not outside or not agrees


def test_a_rate_is_far_above_only_in_a_conclusive_window() -> None:
    assert Rate(2.0, 9, 4.0, 0.5).is_far_above(0.5, 4.0)
    assert not Rate(0.7, 4, 4.0, 1.4).is_far_above(0.5, 4.0)
    assert not Rate(2.0, 3, 1.0, 0.5).is_far_above(0.5, 4.0)
    assert not Rate(2.0, 9, 4.0, 0.01).is_far_above(0.5, 4.0), "in bursts"


@pytest.mark.parametrize("times", [[], [5.0], [5.0, 5.0], [5.0, 5.0, 5.0]])
def test_too_few_times_for_a_rate(times: list[float]) -> None:
    assert measure([sample("/t", 0, at) for at in times]) is None


def test_describe() -> None:
    assert describe(None, 0) == "no message"
    assert describe(None, 1) == "only 1 message"
    assert describe(None, 2) == "only 2 messages"
    assert describe(Rate(2.0, 5, 2.0), 5) == "2.00 Hz (5 messages in 2.00 s)"


def test_cpu_wait_excuses_too_few_messages_in_proportion_but_never_too_many() -> None:
    assert not too_few_by_cpu_wait(5, 10.0, cpu_wait_s=0.0, elapsed_s=1.0)
    assert too_few_by_cpu_wait(5, 10.0, cpu_wait_s=0.5, elapsed_s=1.0)
    assert not too_few_by_cpu_wait(1, 10.0, cpu_wait_s=0.5, elapsed_s=1.0)
    assert not too_few_by_cpu_wait(20, 10.0, cpu_wait_s=0.9, elapsed_s=1.0)
    assert too_few_by_cpu_wait(0, 10.0, cpu_wait_s=1.0, elapsed_s=1.0)
    assert not too_few_by_cpu_wait(0, 0.5, cpu_wait_s=0.1, elapsed_s=1.0)


@given(st.floats(0.5, 10), st.integers(2, 8), st.integers(3, 8))
def test_bursts_agree_with_no_rate(hz: float, size: int, bursts: int) -> None:
    every_s = size / hz
    times = [5.0 + burst * every_s + i * 1e-4 for burst in range(bursts) for i in range(size)]
    rate = measure([sample("/t", 0, at) for at in times])
    assert rate is not None
    assert rate.in_bursts == (size > 2 or len(times) >= MIN_FOR_BURSTS)
    assert not rate.in_bursts or not rate.agrees_with(rate.hz)


@given(st.floats(0.5, 10), st.integers(5, 40), st.integers())
def test_jitter_and_a_pause_are_not_bursts(hz: float, count: int, seed: int) -> None:
    rng = random.Random(seed)
    pause_after = rng.randrange(count)
    times = [5.0 + (i + rng.uniform(-0.2, 0.2) + (1.0 if i > pause_after else 0.0)) / hz for i in range(count)]
    rate = measure([sample("/t", 0, at) for at in times])
    assert rate is not None
    assert not rate.in_bursts
    assert "bursts" not in str(rate)


@pytest.mark.parametrize(
    ("gaps_s", "even"),
    [
        ([1.0, 1.0, 1.0], True),
        ([1.0, 1.05, 0.98], True),
        ([1.0, 1.0, 1.0, 1.3], False),
        ([0.1, 0.1, 0.05, 0.05], False),  # the tick of a second timer
        ([1.0, 1.0], False),  # too few
        ([], False),
    ],
)
def test_evenly_sent_messages(gaps_s: list[float], even: bool) -> None:
    times = [sum(gaps_s[:count]) for count in range(len(gaps_s) + 1)]
    assert are_even([sample("/t", 1.0, at) for at in times]) == even
    assert MIN_EVEN == 4


class FakeRun:
    """A node that sends messages at these times, with a clock that advances only during `until`."""

    def __init__(self, times: Sequence[float], cpu_wait_share: float = 0.0) -> None:
        self._times, self._cpu_wait_share, self._now = times, cpu_wait_share, 0.0

    def now(self) -> float:
        return self._now

    def node_cpu_wait_s(self) -> float:
        return self._cpu_wait_share * self._now

    def our_cpu_wait_s(self) -> float:
        return 0.0

    def samples_on(self, topic: str) -> list[Sample]:
        return [Sample(topic, {"data": 1.0}, at, at) for at in self._times if at <= self._now]

    async def until(self, seen: Callable[[], bool], limit_s: float, *, idle_s: float | None = None) -> bool:
        ends = self._now + limit_s
        while not seen() and self._now < ends:
            self._now += 0.01
        return seen()


def _ticks(hz: float, *, from_s: float = 0.0, to_s: float = 20.0) -> list[float]:
    return [from_s + 0.03 + number / hz for number in range(int((to_s - from_s) * hz))]


@pytest.mark.parametrize("asked_hz", [10.0, 5.0, 0.75])
@pytest.mark.parametrize(
    ("factor", "cpu_wait_share", "windows"),
    [
        (1.0, 0.0, 1),
        (2.0, 0.0, 1),  # wrong, but even: another window would show the same
        (2.0, 0.1, 2),  # the node had to wait for the CPU
    ],
)
async def test_a_rate_is_measured_again_unless_messages_are_even(
    asked_hz: float, factor: float, cpu_wait_share: float, windows: int
) -> None:
    run = FakeRun(_ticks(asked_hz * factor), cpu_wait_share)
    rate, _ = await measure_steady_rate(run, "/t", asked_hz, since=0.0)  # type: ignore[arg-type]
    assert rate is not None
    assert rate.hz == pytest.approx(asked_hz * factor, rel=0.01)
    first_s = window_s(asked_hz) + 0.5 / asked_hz
    assert run.now() == pytest.approx(first_s + (windows - 1) * max(window_s(asked_hz), REMEASURE_S), abs=0.4)


async def test_a_rate_far_below_is_measured_until_its_messages_are_seen_to_be_even() -> None:
    run = FakeRun(_ticks(2.0))
    rate, messages = await measure_steady_rate(run, "/t", 10.0, since=0.0)  # type: ignore[arg-type]
    assert rate is not None
    assert rate.hz == pytest.approx(2.0)
    assert messages == MIN_EVEN
    assert run.now() < 2.0


async def test_a_rate_far_below_is_measured_for_longer_if_the_node_waits_for_a_cpu() -> None:
    run = FakeRun(_ticks(2.0), cpu_wait_share=0.1)
    rate, messages = await measure_steady_rate(run, "/t", 10.0, since=0.0)  # type: ignore[arg-type]
    assert rate is not None
    assert rate.hz == pytest.approx(2.0)
    assert messages == 2 * REMEASURE_S
    assert run.now() > REMEASURE_S


async def test_a_hiccup_in_the_first_window_does_not_count() -> None:
    stalled = [*_ticks(10, to_s=0.4), *_ticks(10, from_s=0.95)]
    rate, _ = await measure_steady_rate(FakeRun(stalled), "/t", 10.0, since=0.0)  # type: ignore[arg-type]
    assert rate is not None
    assert rate.hz == pytest.approx(10.0, rel=0.01)


@pytest.mark.parametrize(("cpu_wait_share", "windows"), [(0.0, 1), (0.1, 2)])
async def test_the_messages_of_a_second_timer_are_too_many_for_a_hiccup(cpu_wait_share: float, windows: int) -> None:
    run = FakeRun(sorted([*_ticks(0.75), *_ticks(1.0, from_s=0.4)]), cpu_wait_share)
    rate, _ = await measure_steady_rate(run, "/t", 0.75, since=0.0)  # type: ignore[arg-type]
    assert rate is not None
    assert rate.hz > 1.2
    assert run.now() == pytest.approx(3.33 + (windows - 1) * REMEASURE_S, abs=0.4)


async def test_a_flood_is_measured_no_longer_than_it_takes_to_see_it() -> None:
    run = FakeRun(_ticks(500.0), cpu_wait_share=0.5)
    rate, messages = await measure_steady_rate(run, "/t", 5.0, since=0.0)  # type: ignore[arg-type]
    assert rate is not None
    assert rate.hz == pytest.approx(500.0)
    assert 20 <= messages <= 40
    assert run.now() < 0.3
