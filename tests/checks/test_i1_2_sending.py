"""I1.2: the times at which our publisher sends."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import pytest

from checks.i1_2.facts import Sent
from checks.i1_2.scenarios import _send


class FakeRun:
    """A run by a clock of its own; each wait takes some extra time, in seconds."""

    exit = None

    def __init__(self, extra_s: list[float] | None = None) -> None:
        self._now, self._extra_s = 1000.0, list(extra_s or [])

    def now(self) -> float:
        return self._now

    def node_cpu_wait_s(self) -> float:
        return 0.0

    async def until(self, seen: Callable[[], bool], limit_s: float) -> bool:
        self._now += limit_s + (self._extra_s.pop(0) if self._extra_s else 0.0)
        return seen()

    def publish(self, values: dict[str, str]) -> Any:
        return SimpleNamespace(source_time=self._now)


async def send(run: FakeRun, sent: list[Sent], count: int, hz: float) -> list[float]:
    """Send messages, and return the seconds between those sent now."""
    before, bench = len(sent), SimpleNamespace(report_progress=lambda *_: None)
    await _send(bench, run, run, sent, range(count), hz)  # type: ignore[arg-type]
    return [round(later.at - earlier.at, 3) for earlier, later in pairwise(sent[before:])]


async def test_a_publisher_that_comes_after_a_pause_sends_at_its_rate_and_does_not_catch_up() -> None:
    run, sent = FakeRun(), list[Sent]()
    assert await send(run, sent, 3, 8.0) == [0.125, 0.125]
    await run.until(lambda: False, 2.0)
    assert await send(run, sent, 5, 10.0) == [0.1] * 4


async def test_the_rate_goes_on_across_a_jump() -> None:
    run, sent = FakeRun(), list[Sent]()
    await send(run, sent, 2, 8.0)
    await send(run, sent, 2, 8.0)
    assert sent[2].at - sent[1].at == pytest.approx(0.125)


async def test_a_message_that_was_late_is_caught_up_with_but_never_by_two_at_once() -> None:
    run = FakeRun([0.0, 0.15])
    spans = await send(run, [], 6, 10.0)
    assert spans[:2] == [0.1, 0.25]
    assert min(spans) == 0.05
    assert sum(spans) == pytest.approx(0.5)
