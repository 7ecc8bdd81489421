"""With `first`, a check ends at its first failure and reports what was not judged."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from tests.engine.helpers import FILE, WAITS, Scene, criterion, statuses
from tests.failures import failure
from tutor.judge.bench import Bench
from tutor.judge.check import Criterion
from tutor.judge.events import CriterionJudged
from tutor.judge.result import CriterionResult
from tutor.judge.verdict import Status, Verdict, passed

pytestmark = pytest.mark.usefixtures("ros")

FAILED = failure("this", "that", ("no", "it does not", "do it"))


def fails(*facts: Any) -> Verdict:
    return FAILED


async def no_facts(bench: Bench) -> str:
    return "nothing"


async def _judge(*verdicts: Verdict | None, bonus: tuple[int, ...] = ()) -> tuple[dict[str, Status], str]:
    """Judge criteria c0, c1, ... with these verdicts, in this order; with None, the judge never returns."""
    from tutor.engine.runner import judge_until_failure  # imports rclpy

    async def judge(criterion: Criterion) -> CriterionResult:
        index = int(criterion.id[1:])
        for _ in range(index):
            await asyncio.sleep(0)
        if (verdict := verdicts[index]) is None:
            await asyncio.Event().wait()
        assert verdict is not None
        return CriterionResult(criterion.id, "", criterion.bonus, verdict, 0.0)

    criteria = [Criterion(f"c{n}", fails, (), bonus=n in bonus) for n in range(len(verdicts))]
    results, failure = await asyncio.wait_for(judge_until_failure(criteria, judge), 20)
    return {id: result.verdict.status for id, result in results.items()}, failure


async def test_everything_is_judged_if_no_required_criterion_fails() -> None:
    good = passed("a", "b")
    assert await _judge(good, good) == ({"c0": Status.PASSED, "c1": Status.PASSED}, "")
    assert await _judge(good, FAILED, good, bonus=(1,)) == (
        {"c0": Status.PASSED, "c1": Status.FAILED, "c2": Status.PASSED},
        "",
    )


async def test_criteria_without_a_verdict_at_the_first_failure_are_left_unjudged() -> None:
    assert await _judge(passed("a", "b"), FAILED, None) == ({"c0": Status.PASSED, "c1": Status.FAILED}, "c1")
    assert await _judge(None, FAILED, bonus=(0, 1)) == ({"c1": Status.FAILED}, "c1")  # all criteria are bonus


async def test_nodes_are_ended_and_unjudged_criteria_are_skipped_with_the_reason(scene: Scene) -> None:
    async def up(bench: Bench) -> str:
        async with bench.start(FILE) as run:
            assert await run.until(lambda: bool(run.output), 30)
            started.set()
            await run.until(lambda: False, 1000)
        raise AssertionError("must not be reached")

    async def then(bench: Bench) -> str:
        await started.wait()
        return "up"

    started = asyncio.Event()
    result = await scene.judge(
        criterion("slow", up),
        criterion("fails", then, judge=fails),
        criterion("after", up, after=("fails",)),
        criterion("later", up, after=("slow",)),
        criterion("good", no_facts),
        source=WAITS,
        first=True,
    )
    assert not scene.leftovers()
    assert not scene.reserved_domains
    assert statuses(result) == {
        "slow": "skipped",
        "fails": "failed",
        "after": "skipped",
        "later": "skipped",
        "good": "passed",
    }
    causes = {each.id: each.verdict.cause for each in result.criteria}
    assert causes["slow"] == causes["later"] == "not judged, because the check ended at its first failure, `fails`"
    assert causes["after"] == "not judged, because `fails` did not pass"
    assert "slow" in result.unjudged
    assert "good" not in result.unjudged
    assert result.verdict is Status.FAILED
    judged = [event.result for event in scene.events if isinstance(event, CriterionJudged)]
    assert sorted(judged, key=lambda each: each.id) == sorted(result.criteria, key=lambda each: each.id)
