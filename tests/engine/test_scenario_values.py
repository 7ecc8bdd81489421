"""Scenarios that are values: equal ones are one run, for judges and early judges alike."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass

from tests.engine.helpers import Scene
from tutor.judge.bench import Bench
from tutor.judge.check import Criterion
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Trace
from tutor.judge.verdict import Verdict, failed, passed

runs: list[int] = []


@dataclass(frozen=True)
class Count:
    """Counts its runs. `number`: what makes it another scenario."""

    number: int

    async def __call__(self, bench: Bench) -> int:
        runs.append(self.number)
        return self.number


async def never(bench: Bench) -> int:
    await asyncio.sleep(60)
    return 0


def judge(*numbers: int) -> Verdict:
    return passed("a number", str(numbers))


def fail_early(number: int) -> Verdict:
    return failed("another number", str(number), Symptom.WRONG_VALUES.seen(Trace("node.py")))


async def test_equal_scenarios_run_once(scene: Scene) -> None:
    runs.clear()
    result = await scene.judge(
        Criterion("one", judge, (Count(1),)),
        Criterion("both", judge, (Count(2), Count(1))),
        Criterion("again", judge, (Count(2),)),
    )
    assert sorted(runs) == [1, 2]
    assert [criterion.verdict.observed for criterion in result.criteria] == ["(1,)", "(2, 1)", "(2,)"]


async def test_an_early_judge_gets_the_facts_of_an_equal_scenario(scene: Scene) -> None:
    result = await scene.judge(Criterion("early", judge, (Count(1), never), early=((Count(1), fail_early),)))
    assert result.criteria[0].verdict.observed == "1"
