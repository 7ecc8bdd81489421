"""When a node that is waited for is taken to be idle."""

from __future__ import annotations

import math

import pytest

from tutor.engine import idle
from tutor.process import NextWake

DEADLINE = 1000.0


class Watched:
    """A process at a time, and what it and we are doing."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now, self.wake, self.cpu_wait_s = 50.0, NextWake(math.inf, 7), 3.0
        monkeypatch.setattr("time.monotonic", lambda: self.now)
        self.idle = idle.Idle(lambda: self.wake, lambda: self.cpu_wait_s, 0.7)

    def after(self, seconds: float) -> bool:
        self.now += seconds
        return self.idle.until(DEADLINE)


@pytest.fixture
def watched(monkeypatch: pytest.MonkeyPatch) -> Watched:
    return Watched(monkeypatch)


def test_it_has_done_nothing_for_that_long(watched: Watched) -> None:
    assert [watched.after(0.2) for _ in range(6)] == [False, False, False, False, True, True]


def test_it_ran_in_between(watched: Watched) -> None:
    watched.after(0.2)
    watched.after(0.6)
    watched.wake = NextWake(math.inf, 8)
    assert [watched.after(0.3) for _ in range(4)] == [False, False, False, True]


@pytest.mark.parametrize(("at", "expected"), [(0.0, False), (DEADLINE - 1, False), (DEADLINE + 1, True)])
def test_it_wakes_up_later(watched: Watched, at: float, expected: bool) -> None:
    watched.wake = NextWake(at, 7)
    assert [watched.after(0.5) for _ in range(4)][-1] is expected


def test_we_may_not_have_seen_what_it_did(watched: Watched) -> None:
    watched.after(0.2)
    watched.cpu_wait_s += 1.0
    assert [watched.after(0.6) for _ in range(3)] == [False, False, True]
