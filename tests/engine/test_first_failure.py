"""A check that ends at its first failure: nothing is waited for any more, and the report says what was not judged."""

from __future__ import annotations

import asyncio
from typing import Any

from tests.engine.made import FILE, WAITS, Scene, criterion, plain
from tutor.engine.first_failure import judge_until_failure
from tutor.judge.bench import Bench
from tutor.judge.check import Criterion
from tutor.judge.events import CriterionJudged
from tutor.judge.result import CriterionResult
from tutor.judge.verdict import Cause, Status, Verdict, failed, passed

NO = failed("this", "that", Cause("no", "it does not", "do it"))


def fails(*facts: Any) -> Verdict:
    return NO


async def nothing(bench: Bench) -> str:
    return "nothing"


async def _judged(*verdicts: Verdict | None, bonus: tuple[int, ...] = ()) -> tuple[dict[str, Status], str]:
    """Criteria c0, c1, ... with these verdicts, in this order; one without never comes."""

    async def judge(criterion: Criterion) -> CriterionResult:
        at = int(criterion.id[1:])
        for _ in range(at):
            await asyncio.sleep(0)
        if (verdict := verdicts[at]) is None:
            await asyncio.Event().wait()
        assert verdict is not None
        return CriterionResult(criterion.id, "", criterion.bonus, verdict, 0.0)

    shown = [Criterion(f"c{n}", fails, (), bonus=n in bonus) for n in range(len(verdicts))]
    results, failure = await asyncio.wait_for(judge_until_failure(shown, judge), 20)
    return {id: result.verdict.status for id, result in results.items()}, failure


async def test_all_is_judged_where_nothing_required_fails() -> None:
    good = passed("a", "b")
    assert await _judged(good, good) == ({"c0": Status.PASSED, "c1": Status.PASSED}, "")
    assert await _judged(good, NO, good, bonus=(1,)) == (
        {"c0": Status.PASSED, "c1": Status.FAILED, "c2": Status.PASSED},
        "",
    )


async def test_what_has_no_verdict_at_the_first_failure_gets_none() -> None:
    assert await _judged(passed("a", "b"), NO, None) == ({"c0": Status.PASSED, "c1": Status.FAILED}, "c1")
    assert await _judged(None, NO, bonus=(0, 1)) == ({"c1": Status.FAILED}, "c1")  # only a bonus was asked for


async def test_the_nodes_are_ended_and_what_was_not_judged_is_skipped_with_the_reason(scene: Scene) -> None:
    async def up(bench: Bench) -> str:
        async with bench.start(FILE) as run:
            assert await run.until(lambda: bool(run.output), 30)
            started.set()
            await run.until(lambda: False, 1000)
        raise AssertionError("not to be waited for")

    async def then(bench: Bench) -> str:
        await started.wait()
        return "up"

    started = asyncio.Event()
    result = await scene.judge(
        criterion("slow", up),
        criterion("fails", then, judge=fails),
        criterion("after", up, after=("fails",)),
        criterion("later", up, after=("slow",)),
        criterion("good", nothing),
        source=WAITS,
        first=True,
    )
    assert not scene.left()
    assert not scene.held
    assert plain(result) == {
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
    told = [event.result for event in scene.events if isinstance(event, CriterionJudged)]
    assert sorted(told, key=lambda each: each.id) == sorted(result.criteria, key=lambda each: each.id)
