"""Judge submissions several times, each time in another way, and list each criterion whose status varies.

The status of a criterion must not depend on how a check is run, nor on a race: the app, the command line, a check of
one criterion alone and one that ends at its first failure take turns, while others are judged beside them.
"""

from __future__ import annotations

import asyncio
import json
import os
import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum

from tests.judging import LIMIT_S, NoVerdict, laid_out, run_engine, run_to_end
from tutor.content.submissions import Case
from tutor.judge.result import ExerciseResult


class Way(Enum):
    """How a check is run."""

    APP = "app"
    COMMAND_LINE = "command line"
    ALONE = "one criterion alone"
    FIRST = "--first"


@dataclass(frozen=True, slots=True)
class JudgedRun:
    """The statuses of one run, by criterion. `fault`: why there are none; empty if there are."""

    case: Case
    way: Way
    statuses: Mapping[str, str]
    fault: str = ""


async def judge_in_turn(case: Case, number: int, criteria: Sequence[str]) -> JudgedRun:
    """Judge a submission for the `number`th time (from 0), in the way that is next; `criteria`: the exercise's."""
    with laid_out(case) as files:
        return replace(await _judge_files(files, number, criteria), case=case)


async def _judge_files(case: Case, number: int, criteria: Sequence[str]) -> JudgedRun:
    rounds, place = divmod(number, len(Way))
    way = list(Way)[place]
    try:
        if way is Way.COMMAND_LINE:
            return JudgedRun(case, way, await _judge_on_the_command_line(case))
        only = [criteria[rounds % len(criteria)]] if way is Way.ALONE else []
        result, _ = await run_engine(case.exercise, case.folder, only, first=way is Way.FIRST)
        return JudgedRun(case, way, _statuses(result))
    except NoVerdict as error:
        return JudgedRun(case, way, {}, str(error))


def _statuses(result: ExerciseResult) -> dict[str, str]:
    return {each.id: each.verdict.status.value for each in result.criteria if each.id not in result.unjudged}


async def _judge_on_the_command_line(case: Case) -> dict[str, str]:
    out, err, code = await run_to_end(
        [sys.executable, "-m", "tutor", "check", case.exercise, str(case.folder), "--format=json"], dict(os.environ)
    )
    try:
        (exercise,) = json.loads(out)["exercises"]
    except (json.JSONDecodeError, KeyError, ValueError):
        raise NoVerdict(f"no verdict: exit code {code}: {err.decode()[-500:]}") from None
    return {each["id"]: each["status"] for each in exercise["criteria"]}


def variations(runs: Sequence[JudgedRun]) -> list[str]:
    """List the criteria whose status varies, each with how often it had which status and in which way."""
    lines = []
    for name in sorted({str(run.case) for run in runs}):
        own = [run for run in runs if str(run.case) == name]
        lines += [f"{name}: {run.way.value}: {run.fault}" for run in own if run.fault]
        for criterion in dict.fromkeys(each for run in own for each in run.statuses):
            judged = [(run.statuses[criterion], run.way) for run in own if criterion in run.statuses]
            counts = Counter(status for status, _ in judged)
            if len(counts) > 1:
                texts = []
                for status, times in counts.most_common():
                    ways = sorted({way.value for each, way in judged if each == status})
                    texts.append(f"{times} times {status} ({', '.join(ways)})")
                lines.append(f"{name}: {criterion}: {'; '.join(texts)}")
    return lines


async def judge_again_and_again(
    cases: Sequence[Case], times: int, jobs: int, criteria: Mapping[str, Sequence[str]]
) -> list[JudgedRun]:
    """Judge each case `times` times, `jobs` runs at a time, reporting each case on stderr once it is through.

    `criteria`: those of each exercise. The runs of one case are far apart, so that they do not meet the same load.
    """
    slots = asyncio.Semaphore(jobs)
    runs: list[JudgedRun] = []

    async def judge_one(case: Case, number: int) -> None:
        async with slots:
            run = await asyncio.wait_for(judge_in_turn(case, number, criteria[case.exercise]), 2 * LIMIT_S)
        runs.append(run)
        own = [each for each in runs if each.case is case]
        if len(own) == times:
            lines = variations(own)
            text = "\n        ".join([f"{'! ' if lines else '  '}{len(runs)}/{times * len(cases)}  {case}", *lines])
            print(text, file=sys.stderr, flush=True)

    await asyncio.gather(*(judge_one(case, number) for number in range(times) for case in cases))
    return runs
