"""A check that ends at its first failure: collect the results up to then, and explain why the rest was not judged."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Mapping, Sequence

from tutor.judge.check import Criterion
from tutor.judge.result import CriterionResult
from tutor.judge.verdict import Status, Verdict, skipped


async def judge_until_failure(
    shown: Sequence[Criterion], judge: Callable[[Criterion], Awaitable[CriterionResult]]
) -> tuple[Mapping[str, CriterionResult], str]:
    """Judge all criteria concurrently, and stop at the first failure.

    Return the results by then (id to result), and the id of the failed criterion ("" if none failed). The failure of a
    bonus criterion counts only if all of `shown` are bonus criteria. An exception raised by `judge` is passed on.
    """
    tasks = {asyncio.ensure_future(judge(criterion)): criterion for criterion in shown}
    only_bonus = all(criterion.bonus for criterion in shown)
    pending, failure = set(tasks), ""
    try:
        while pending and not failure:
            _, pending = await asyncio.wait(pending, return_when=asyncio.FIRST_COMPLETED)
            failed = [
                criterion.id
                for task, criterion in tasks.items()
                if task.done() and task.result().verdict.status is Status.FAILED and (only_bonus or not criterion.bonus)
            ]
            failure = next(iter(failed), "")
    finally:
        for task in pending:
            task.cancel()
        await asyncio.gather(*pending, return_exceptions=True)
    return {criterion.id: task.result() for task, criterion in tasks.items() if not task.cancelled()}, failure


def skipped_verdict(criterion: Criterion, results: Mapping[str, CriterionResult], failure: str) -> Verdict:
    """The verdict on a criterion that was not judged: a dependency did not pass, or the check ended at `failure`."""
    for dependency in criterion.after:
        if dependency in results and not results[dependency].verdict.passed:
            return skipped_after(dependency, results[dependency].verdict)
    return skipped(f"not judged, because the check ended at its first failure, `{failure}`")


def skipped_after(dependency: str, verdict: Verdict) -> Verdict:
    """The verdict on a criterion whose dependency got this verdict; the reason is the same if that was skipped, too."""
    return verdict if verdict.status is Status.SKIPPED else skipped(f"not judged, because `{dependency}` did not pass")
