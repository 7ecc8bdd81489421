"""Run the scenarios of a check concurrently, judge each criterion as soon as its facts are in, and stream events."""

from __future__ import annotations

import asyncio
import time
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from tutor.content import Lesson
from tutor.engine.bench import RosBench
from tutor.engine.explanation import explain
from tutor.engine.first_failure import judge_until_failure, skipped_after, skipped_verdict
from tutor.engine.not_shown import items_not_shown, read_all_sources
from tutor.engine.provisional import Provisional
from tutor.engine.sandbox import Sandboxes
from tutor.engine.so_far import SoFar
from tutor.engine.start_limiter import StartLimiter
from tutor.engine.unchanged_skeleton import first_todo, point_to_todo
from tutor.engine.waits import TOO_BUSY
from tutor.errors import Fault, MachineTooBusy
from tutor.judge.bench import Scenario, was_slowed
from tutor.judge.check import Check, Criterion
from tutor.judge.events import WAITING, CheckStarted, CriterionJudged, Event, ExerciseJudged, Progress
from tutor.judge.result import CriterionResult, ExerciseResult, Remark, tell_roots_once
from tutor.judge.submission import Submission
from tutor.judge.verdict import Status, Undecided, Verdict, bounded, fault
from tutor.process.fork_link import ForkServerLink
from tutor.ros.environment import RosEnvironment
from tutor.workspace import digests_of
from tutor.workspace.given_code import given_criteria

OnEvent = Callable[[Event], None]

MAX_REPEATS = 2
"""Maximum repetitions of a scenario because of a busy machine."""

REPEAT_WITHIN_S = 60.0
"""No repetition starts after this much of the check: the machine, or the node itself, is not going to calm down."""


class Runner:
    """One check of one submission.

    `only`: ids of the criteria to show (None: all); their dependencies are judged too, but not shown. `first`: stop at
    the first required criterion that fails. `tools`: see `Prepared`. `limit_s`: what is not judged by then is an error.
    """

    def __init__(
        self,
        check: Check,
        lesson: Lesson,
        submission: Submission,
        ros: RosEnvironment,
        only: frozenset[str] | None,
        on_event: OnEvent,
        start_limiter: StartLimiter | None = None,
        sandboxes: Sandboxes | None = None,
        fork_server: ForkServerLink | None = None,
        *,
        tools: Path | None = None,
        first: bool = False,
        limit_s: float | None = None,
    ) -> None:
        self._check = check
        self._texts = {text.id: text for text in lesson.criteria}
        self._lesson = lesson
        self._submission = submission
        self._ros = ros
        self._shown = tuple(c for c in check.criteria if only is None or c.id in only)
        self._on_event = on_event
        self._start_limiter = start_limiter or StartLimiter()
        self._sandboxes = sandboxes
        self._fork_server = fork_server
        self._tools = tools
        self._first = first
        self._limit_s = limit_s
        self._deadline: float | None = None
        self._scenarios: dict[Scenario[Any], asyncio.Task[Any]] = {}
        self._verdicts: dict[str, asyncio.Task[Verdict]] = {}
        self._early: dict[str, asyncio.Future[Verdict]] = {}
        self._repeats: Counter[Scenario[Any]] = Counter()
        self._progress: dict[Scenario[Any], tuple[float, str, SoFar]] = {}
        self._published: set[str] = set()
        self._todo = first_todo(lesson, submission)
        self._announced = False
        self._started = time.monotonic()

    def announce_waiting(self) -> None:
        """Emit events: the check is going to start, but is waiting for its turn."""
        self._announce()
        for criterion in self._shown:
            self._on_event(Progress(self._check.exercise, criterion.id, 0.0, WAITING))

    async def run(self) -> ExerciseResult:
        """Judge all criteria. When this returns, every scenario has ended and no process of the learner's is left."""
        exercise = self._check.exercise
        self._announce()
        self._started = time.monotonic()
        if self._limit_s is not None:
            self._deadline = asyncio.get_running_loop().time() + self._limit_s
        digests, given = digests_of(self._submission.files), given_criteria(self._lesson, self._submission)
        sources = read_all_sources(self._submission)
        needed = _with_dependencies(self._check, self._shown)
        try:
            for criterion in needed:
                for scenario in criterion.facts:
                    self._task_of(scenario)
            for criterion in needed:
                self._early[criterion.id] = asyncio.get_running_loop().create_future()
                self._verdicts[criterion.id] = asyncio.create_task(self._judge(criterion))
            results, unjudged = await self._judge_shown()
        finally:
            await _cancel([*self._verdicts.values(), *self._scenarios.values()])
        result = ExerciseResult(
            id=exercise,
            title=self._lesson.title,
            submission=tuple(self._submission.files),
            criteria=tell_roots_once(results),
            duration_s=self._elapsed_s(),
            unjudged=unjudged,
            digests=digests,
            given=given,
            not_shown=items_not_shown(self._lesson, sources, results),
        )
        if result.verdict is Status.PASSED and not unjudged:
            result = replace(result, remarks=self._remarks(sources, results))
        self._on_event(ExerciseJudged(result))
        return result

    def _remarks(self, sources: Mapping[str, str], results: Sequence[CriterionResult]) -> tuple[Remark, ...]:
        from tutor.mistakes import remarks  # late, as in `explain`

        return remarks(sources, self._check, [each.verdict.mistake for each in results])

    async def _judge_shown(self) -> tuple[Sequence[CriterionResult], tuple[str, ...]]:
        """Judge the criteria to show; return their results, and the ids of those skipped at the first failure."""
        if not self._first:
            return await asyncio.gather(*(self._result_of(criterion) for criterion in self._shown)), ()
        judged, failure = await judge_until_failure(self._shown, self._result_of)
        unjudged = [criterion for criterion in self._shown if criterion.id not in judged]
        skipped = {each.id: self._emit_verdict(each, skipped_verdict(each, judged, failure)) for each in unjudged}
        results = {**judged, **skipped}
        return [results[criterion.id] for criterion in self._shown], tuple(each.id for each in unjudged)

    def _announce(self) -> None:
        if not self._announced:
            self._announced = True
            self._on_event(CheckStarted(self._check.exercise, tuple(c.id for c in self._shown)))

    def _task_of(self, scenario: Scenario[Any]) -> asyncio.Task[Any]:
        """Return the task that gathers a scenario's facts; start it on first use."""
        if scenario not in self._scenarios:
            self._scenarios[scenario] = asyncio.ensure_future(self._gather_facts(scenario))
        return self._scenarios[scenario]

    def _repeat(self, scenario: Scenario[Any], last: asyncio.Task[Any], *, alone: bool) -> bool:
        """Start the scenario again, unless its `last` run already was repeated. Return False if out of repetitions."""
        if self._scenarios[scenario] is last:
            if self._repeats[scenario] >= MAX_REPEATS or self._elapsed_s() > REPEAT_WITHIN_S:
                return False
            self._repeats[scenario] += 1
            self._scenarios[scenario] = asyncio.ensure_future(self._gather_facts(scenario, alone=alone))
        return True

    async def _facts_for_scenario(self, scenario: Scenario[Any]) -> Any:
        """Return the facts of a scenario that another scenario asks for."""
        with self._start_limiter.scenarios.waiting():
            # Shielded: the cancellation of one waiter must not cancel a scenario that others are waiting for, too.
            return await asyncio.shield(self._task_of(scenario))

    async def _gather_facts(self, scenario: Scenario[Any], *, alone: bool = False) -> Any:
        """Run a scenario for its facts, and repeat it alone if the machine was too busy to let the node run."""
        for _ in range(MAX_REPEATS):
            try:
                return await self._run_scenario(scenario, alone=alone)
            except MachineTooBusy:
                if self._elapsed_s() > REPEAT_WITHIN_S:
                    raise
                alone = True
        return await self._run_scenario(scenario, alone=alone)

    async def _run_scenario(self, scenario: Scenario[Any], *, alone: bool) -> Any:
        def on_progress(fraction: float, text: str, so_far: SoFar) -> None:
            self._emit_progress(scenario, fraction, text, so_far)

        provisional = Provisional(on_progress, self._lesson.live, self._published)
        bench = RosBench(
            self._submission,
            self._ros,
            self._facts_for_scenario,
            provisional.report,
            self._start_limiter,
            self._check.expected_s,
            self._sandboxes,
            provisional.follow,
            lambda facts: self._take_facts(scenario, facts),
            fork_server=self._fork_server,
            tools=self._tools,
        )
        async with self._start_limiter.scenarios.running(alone=alone):
            if alone and self._elapsed_s() > REPEAT_WITHIN_S:
                raise MachineTooBusy(TOO_BUSY)
            facts = await scenario(bench)
            if bench.sigkilled:  # one run does not show who sent the signal
                facts = await scenario(bench)
        self._take_facts(scenario, facts)
        return facts

    async def _judge(self, criterion: Criterion) -> Verdict:
        for dependency in criterion.after:
            if not (verdict := await asyncio.shield(self._verdicts[dependency])).passed:
                return skipped_after(dependency, verdict)
        try:
            verdict = explain(await self._judge_early_or_fully(criterion), self._check)
            text = self._texts.get(criterion.id)
            return point_to_todo(verdict, self._todo, text.hint if text else "")
        except Fault as error:
            return fault(str(error), error.hint)
        except Exception as error:  # the check's boundary: our bug must not be reported as the learner's
            return fault(
                f"the check itself failed: {type(error).__name__}: {error}",
                "this is a fault of ros-tutor, not of your code; please report it with the line below",
                [_raising_line(error)],
            )

    def _take_facts(self, scenario: Scenario[Any], facts: object) -> None:
        """Pass a scenario's facts so far to its early judges: a failure that is already certain is final."""
        if was_slowed(facts):
            return
        for criterion in self._check.criteria:
            early = self._early.get(criterion.id)
            for source, judge in criterion.early:
                if early is None or early.done() or source != scenario:
                    continue
                verdict = judge(facts)
                if verdict is not None and verdict.status is Status.FAILED:
                    early.set_result(verdict)

    async def _judge_early_or_fully(self, criterion: Criterion) -> Verdict:
        early, full = self._early[criterion.id], asyncio.ensure_future(self._judge_fully(criterion))
        try:
            await asyncio.wait({early, full}, return_when=asyncio.FIRST_COMPLETED)
            return full.result() if full.done() else early.result()
        finally:
            await _cancel([full])

    async def _judge_fully(self, criterion: Criterion) -> Verdict:
        """Judge a criterion, and repeat its scenarios if the machine may be why it is not met, or skipped."""
        while True:
            runs = [self._task_of(scenario) for scenario in criterion.facts]
            facts = [await asyncio.shield(run) for run in runs]
            if any(self._scenarios[scenario] is not run for scenario, run in zip(criterion.facts, runs, strict=True)):
                continue  # a scenario was repeated in the meantime
            verdict = criterion.judge(*facts)
            undecided = isinstance(verdict, Undecided)
            repeated = [
                self._repeat(scenario, run, alone=undecided)
                for scenario, run, seen in zip(criterion.facts, runs, facts, strict=True)
                if undecided or (verdict.status in (Status.FAILED, Status.SKIPPED) and was_slowed(seen))
            ]
            if not any(repeated):
                return verdict

    async def _result_of(self, criterion: Criterion) -> CriterionResult:
        try:
            async with asyncio.timeout_at(self._deadline):
                verdict = await asyncio.shield(self._verdicts[criterion.id])
        except TimeoutError:
            verdict = fault(
                f"not judged within {self._limit_s:.0f} s", "allow more time with --limit, or look at it alone"
            )
        return self._emit_verdict(criterion, bounded(verdict))

    def _emit_verdict(self, criterion: Criterion, verdict: Verdict) -> CriterionResult:
        text = self._texts.get(criterion.id)
        result = CriterionResult(
            criterion.id, text.text if text else criterion.id, criterion.bonus, verdict, self._elapsed_s()
        )
        self._on_event(CriterionJudged(self._check.exercise, result))
        return result

    def _emit_progress(self, scenario: Scenario[Any], fraction: float, text: str, so_far: SoFar) -> None:
        if self._progress.get(scenario) == (fraction, text, so_far):
            return
        self._progress[scenario] = (fraction, text, so_far)
        for criterion in self._shown:
            if scenario in criterion.facts and not self._is_judged(criterion):
                progress = [self._progress.get(each, (0.0, "", SoFar())) for each in criterion.facts]
                fraction = sum(each for each, _, _ in progress) / len(progress)
                doing = text or next((each for _, each, _ in progress if each), "")
                known = max((each for _, _, each in progress), key=lambda each: each.weight)
                self._on_event(Progress(self._check.exercise, criterion.id, fraction, doing, known.text))

    def _is_judged(self, criterion: Criterion) -> bool:
        task = self._verdicts.get(criterion.id)
        return task is not None and task.done()

    def _elapsed_s(self) -> float:
        return time.monotonic() - self._started


def _with_dependencies(check: Check, shown: Iterable[Criterion]) -> tuple[Criterion, ...]:
    wanted = {criterion.id for criterion in shown}
    for criterion in reversed(check.criteria):
        if criterion.id in wanted:
            wanted.update(criterion.after)
    return tuple(criterion for criterion in check.criteria if criterion.id in wanted)


async def _cancel(tasks: list[asyncio.Task[Any]]) -> None:
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)


def _raising_line(error: BaseException) -> str:
    step = error.__traceback__
    while step is not None and step.tb_next is not None:
        step = step.tb_next
    return f"{step.tb_frame.f_code.co_filename}:{step.tb_lineno}" if step is not None else "unknown place"
