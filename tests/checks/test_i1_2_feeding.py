"""I1.2: what our publisher sends, and when."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from types import SimpleNamespace
from typing import Any, cast

import pytest

from checks.i1_2_message_statistics import plans
from checks.i1_2_message_statistics.feeding import Talker
from tutor.judge.bench import Bench


class FakeRun:
    """A run by a clock of its own; each wait takes some extra time, in seconds."""

    exit, matches = None, 0

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


def talker(run: FakeRun) -> Talker:
    """Our talker in this run, which is its publisher, too."""
    ours = Talker(SimpleNamespace(report_progress=lambda *_: None), run)  # type: ignore[arg-type]
    ours.publisher = run  # type: ignore[assignment]
    return ours


async def send(ours: Talker, count: int, hz: float) -> list[float]:
    """Send messages, and return the seconds between those sent now."""
    before = len(ours.sent)
    await ours.send(range(count), hz)
    return [round(later.at - earlier.at, 3) for earlier, later in pairwise(ours.sent[before:])]


async def test_a_publisher_that_comes_after_a_pause_sends_at_its_rate_and_does_not_catch_up() -> None:
    run = FakeRun()
    ours = talker(run)
    assert await send(ours, 3, 8.0) == [0.125, 0.125]
    await run.until(lambda: False, 2.0)
    assert await send(ours, 5, 10.0) == [0.1] * 4


async def test_the_rate_goes_on_across_a_jump() -> None:
    ours = talker(FakeRun())
    await send(ours, 2, 8.0)
    await send(ours, 2, 8.0)
    assert ours.sent[2].at - ours.sent[1].at == pytest.approx(0.125)


async def test_a_message_that_was_late_is_caught_up_with_but_never_by_two_at_once() -> None:
    spans = await send(talker(FakeRun([0.0, 0.15])), 6, 10.0)
    assert spans[:2] == [0.1, 0.25]
    assert min(spans) == 0.05
    assert sum(spans) == pytest.approx(0.5)


async def stretches_of(plan: plans.Plan) -> tuple[plans.Stretch, ...]:
    async def facts(scenario: object) -> plans.Chosen:
        return plans.Chosen(first=95, left_out=5)

    return await plan(cast(Bench, SimpleNamespace(facts=facts)))


@pytest.mark.parametrize(
    ("plan", "first_of_each", "messages"),
    [
        (plans.steadily, [0], 20),
        (plans.jumping, [95, 117], 33),
        (plans.jumping_twice, [95, 117, 128], 33),
        (plans.jumping_after_zero, [0, 6], 12),
    ],
)
async def test_the_numbers_of_a_plan(plan: plans.Plan, first_of_each: list[int], messages: int) -> None:
    stretches = await stretches_of(plan)
    assert [stretch.numbers[0] for stretch in stretches] == first_of_each
    assert sum(len(stretch.numbers) for stretch in stretches) == messages


async def test_a_new_publisher_repeats_numbers_of_the_first() -> None:
    first, second = await stretches_of(plans.starting_over)
    assert set(first.numbers) & set(second.numbers)
    assert (len(first.numbers), len(second.numbers), second.another_publisher) == (13, 12, True)
