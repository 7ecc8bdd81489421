"""When a node under observation counts as idle."""

from __future__ import annotations

import math

import pytest

from tutor.engine import waits
from tutor.process import NextWake

DEADLINE = 1000.0


class FakeProcess:
    """Wraps an IdleDetector with a fake clock, wake-up time and CPU wait."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now, self.wake, self.cpu_wait_s = 50.0, NextWake(math.inf, 7), 3.0
        monkeypatch.setattr("time.monotonic", lambda: self.now)
        self.may_have_lost = True
        self.idle = waits.IdleDetector(
            lambda by: self.wake,
            lambda: self.cpu_wait_s,
            0.7,
            lossless_s=0.3,
            may_have_lost=lambda: self.may_have_lost,
        )

    def advance(self, seconds: float) -> bool:
        self.now += seconds
        return self.idle.is_idle_until(DEADLINE)


@pytest.fixture
def process(monkeypatch: pytest.MonkeyPatch) -> FakeProcess:
    return FakeProcess(monkeypatch)


def test_a_process_that_does_nothing_becomes_idle(process: FakeProcess) -> None:
    assert [process.advance(0.2) for _ in range(6)] == [False, False, False, False, True, True]


def test_running_in_between_restarts_the_idle_time(process: FakeProcess) -> None:
    process.advance(0.2)
    process.advance(0.6)
    process.wake = NextWake(math.inf, 8)
    assert [process.advance(0.3) for _ in range(4)] == [False, False, False, True]


@pytest.mark.parametrize(("at", "expected"), [(0.0, False), (DEADLINE - 1, False), (DEADLINE + 1, True)])
def test_a_process_that_wakes_before_the_deadline_is_not_idle(process: FakeProcess, at: float, expected: bool) -> None:
    process.wake = NextWake(at, 7)
    assert [process.advance(0.5) for _ in range(4)][-1] is expected


def test_time_without_cpu_for_us_extends_the_idle_time(process: FakeProcess) -> None:
    process.advance(0.2)
    process.cpu_wait_s += 1.0
    assert [process.advance(0.6) for _ in range(3)] == [False, False, True]


def test_a_machine_that_is_always_busy_extends_the_idle_time_sixfold_at_most(process: FakeProcess) -> None:
    process.advance(0.2)
    process.cpu_wait_s += 1000.0
    assert [process.advance(0.5) for _ in range(9)] == [False] * 8 + [True]  # 6 * 0.7 s


def test_less_is_enough_if_nothing_was_lost(process: FakeProcess) -> None:
    process.may_have_lost = False
    assert [process.advance(0.2) for _ in range(4)] == [False, False, True, True]


def test_a_loss_that_shows_while_it_is_idle_counts(process: FakeProcess) -> None:
    process.may_have_lost = False
    assert [process.advance(0.2) for _ in range(3)] == [False, False, True]
    process.may_have_lost = True
    assert [process.advance(0.2) for _ in range(3)] == [False, True, True]


def test_a_short_idle_time_is_not_made_longer(process: FakeProcess) -> None:
    process.idle = waits.IdleDetector(
        lambda by: process.wake, lambda: 0.0, 0.7, lossless_s=1.0, may_have_lost=lambda: False
    )
    assert [process.advance(0.2) for _ in range(6)] == [False, False, False, False, True, True]
