"""A check that ends at its first failure: what is judged by then, and why the rest is not."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Mapping, Sequence

from tutor.judge.check import Criterion
from tutor.judge.result import CriterionResult
from tutor.judge.verdict import Status, Verdict, skipped


async def judge_until_failure(
    shown: Sequence[Criterion], judge: Callable[[Criterion], Awaitable[CriterionResult]]
) -> tuple[Mapping[str, CriterionResult], str]:
    """Judge all at once, and stop when one has failed: the results by then, and the id of that one ("" if none has).

    A bonus criterion that fails ends nothing, unless nothing else is asked for. Whatever `judge` raises ends all of it.
    """
    tasks = {asyncio.ensure_future(judge(criterion)): criterion for criterion in shown}
    only_bonus = all(criterion.bonus for criterion in shown)
    waiting, failure = set(tasks), ""
    try:
        while waiting and not failure:
            _, waiting = await asyncio.wait(waiting, return_when=asyncio.FIRST_COMPLETED)
            failed = [
                criterion.id
                for task, criterion in tasks.items()
                if task.done() and task.result().verdict.status is Status.FAILED and (only_bonus or not criterion.bonus)
            ]
            failure = next(iter(failed), "")
    finally:
        for task in waiting:
            task.cancel()
        await asyncio.gather(*waiting, return_exceptions=True)
    return {criterion.id: task.result() for task, criterion in tasks.items() if not task.cancelled()}, failure


def skip(criterion: Criterion, results: Mapping[str, CriterionResult], failure: str) -> Verdict:
    """Why a criterion was not judged: one that it comes after did not pass, or the check ended at another."""
    for dependency in criterion.after:
        if dependency in results and not results[dependency].verdict.passed:
            return skip_after(dependency)
    return skipped(f"not judged, because the check ended at its first failure, `{failure}`")


def skip_after(dependency: str) -> Verdict:
    """A criterion that comes after one that did not pass."""
    return skipped(f"not judged, because `{dependency}` did not pass")
