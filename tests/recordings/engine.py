"""The engine, `python -m tests.recordings.engine FILE CASE EXERCISE FOLDER`, which also records what judges got."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from tests.recordings.recording import JudgeCall, Recording, outcome, scenario_name, write
from tutor.engine import __main__ as engine
from tutor.engine import loading, run_check
from tutor.judge.check import Check, Criterion
from tutor.judge.result import ExerciseResult, Report
from tutor.judge.verdict import Status, Verdict

Calls = list[tuple[JudgeCall, Verdict | None]]


def recorded(check: Check, calls: Calls) -> Check:
    """The check, with judges that add each of their calls, and its result, to `calls`."""
    return replace(check, criteria=tuple(_recorded(criterion, calls) for criterion in check.criteria))


def _recorded(criterion: Criterion, calls: Calls) -> Criterion:
    def wrap(judge: Callable[..., Any], scenario: str) -> Callable[..., Any]:
        def judge_and_record(*facts: Any) -> Any:
            verdict = judge(*facts)
            calls.append((JudgeCall(criterion.id, scenario, facts), verdict))
            return verdict

        return judge_and_record

    early = tuple((scenario, wrap(judge, scenario_name(scenario))) for scenario, judge in criterion.early)
    return replace(criterion, judge=wrap(criterion.judge, ""), early=early)


def make_recording(case: str, calls: Calls, result: ExerciseResult) -> Recording:
    """Keep, for each criterion, the last call that gave its verdict; none for those that were never judged."""
    kept = []
    for criterion in result.criteria:
        if criterion.verdict.status is Status.ERROR:
            continue
        mine = [
            (call, verdict)
            for call, verdict in calls
            if call.criterion == criterion.id and verdict is not None and verdict.status is criterion.verdict.status
        ]
        same = [call for call, verdict in mine if verdict.observed == criterion.verdict.observed]
        kept += (same or [call for call, _ in mine])[-1:]
    return Recording(case, tuple(kept), {each.id: outcome(each.verdict) for each in result.criteria})


def main() -> int:
    """Run the engine as usual, and write the recording into the folder FILE when it has judged the submission."""
    folder, case, *arguments = sys.argv[1:]
    calls: Calls = []
    load = loading.load_check
    loading.load_check = lambda lesson: recorded(load(lesson), calls)

    async def run_and_keep(*given: Any, **named: Any) -> Report:
        report = await run_check(*given, **named)
        results.extend(report.exercises)
        return report

    results: list[ExerciseResult] = []
    vars(engine)["run_check"] = run_and_keep
    sys.argv[1:] = arguments
    code = engine.main()
    for result in results:
        write(make_recording(case, calls, result), Path(folder))
    return code


if __name__ == "__main__":
    sys.exit(main())
