"""Run the scenarios of a check concurrently, judge each criterion as soon as its facts are in, and stream events."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from tutor.content import Lesson
from tutor.engine.explanation import explain, first_todo, items_not_shown, point_to_todo, read_all_sources
from tutor.engine.interfaces import build_beside, use_own
from tutor.engine.machine import Machine
from tutor.engine.scenarios import Scenarios
from tutor.errors import Fault
from tutor.interfaces import Build
from tutor.judge.bench import Scenario, was_slowed
from tutor.judge.check import Check, Criterion
from tutor.judge.events import WAITING, CheckStarted, CriterionJudged, Event, ExerciseJudged, Progress
from tutor.judge.result import CriterionResult, ExerciseResult, Remark, tell_roots_once
from tutor.judge.submission import Submission
from tutor.judge.verdict import Status, Undecided, Verdict, bounded, fault, skipped
from tutor.workspace import digests_of
from tutor.workspace.given_code import given_criteria

OnEvent = Callable[[Event], None]


class Runner:
    """One check of one submission.

    `only`: ids of the criteria to show (None: all); their dependencies are judged too, but not shown. `first`: stop at
    the first required criterion that fails.
    """

    def __init__(
        self,
        machine: Machine,
        check: Check,
        lesson: Lesson,
        submission: Submission,
        only: frozenset[str] | None,
        on_event: OnEvent,
        *,
        first: bool = False,
    ) -> None:
        self._machine = machine
        self._limit_s = machine.limits.check_s
        self._check = check
        self._texts = {text.id: text for text in lesson.criteria}
        self._lesson = lesson
        self._submission = submission
        self._shown = tuple(c for c in check.criteria if only is None or c.id in only)
        self._on_event = on_event
        self._first = first
        self._deadline: float | None = None
        self._scenarios = Scenarios(
            machine, submission, check.expected_s, lesson.live, self._take_facts, self._emit_progress
        )
        self._verdicts: dict[str, asyncio.Task[Verdict]] = {}
        self._early: dict[str, asyncio.Future[Verdict]] = {}
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
        self._scenarios.interfaces = await self._build_interfaces()
        digests, given = digests_of(self._submission.files), given_criteria(self._lesson, self._submission)
        sources = read_all_sources(self._submission)
        needed = _with_dependencies(self._check, self._shown)
        try:
            for criterion in needed:
                for scenario in criterion.facts:
                    self._scenarios.task_of(scenario)
            for criterion in needed:
                self._early[criterion.id] = asyncio.get_running_loop().create_future()
                self._verdicts[criterion.id] = asyncio.create_task(self._judge(criterion))
            results, unjudged = await self._judge_shown()
        finally:
            await _cancel([*self._verdicts.values(), *self._scenarios.tasks])
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

    async def _build_interfaces(self) -> Sequence[Build]:
        """Build the message types that the submission and the exercise define, if any. Raises EngineError."""
        loop, exercise = asyncio.get_running_loop(), self._check.exercise

        def say(text: str) -> None:
            for criterion in self._shown:
                loop.call_soon_threadsafe(self._on_event, Progress(exercise, criterion.id, 0.0, text))

        first = next(iter(self._submission.files.values()))
        await asyncio.to_thread(use_own, self._lesson, self._machine.ros, say)
        return await asyncio.to_thread(build_beside, first.resolve(), self._machine.ros, say)

    def _remarks(self, sources: Mapping[str, str], results: Sequence[CriterionResult]) -> tuple[Remark, ...]:
        from tutor.mistakes import remarks  # late, as in `explain`

        return remarks(sources, self._check, [result.verdict.mistake for result in results])

    async def _judge_shown(self) -> tuple[Sequence[CriterionResult], tuple[str, ...]]:
        """Judge the criteria to show; return their results, and the ids of those skipped at the first failure."""
        if not self._first:
            return await asyncio.gather(*(self._result_of(criterion) for criterion in self._shown)), ()
        judged, failure = await judge_until_failure(self._shown, self._result_of)
        unjudged = [criterion for criterion in self._shown if criterion.id not in judged]
        skipped = {
            criterion.id: self._emit_verdict(criterion, skipped_verdict(criterion, judged, failure))
            for criterion in unjudged
        }
        results = {**judged, **skipped}
        return [results[criterion.id] for criterion in self._shown], tuple(criterion.id for criterion in unjudged)

    def _announce(self) -> None:
        if not self._announced:
            self._announced = True
            self._on_event(CheckStarted(self._check.exercise, tuple(c.id for c in self._shown)))

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
        """Judge a criterion, and repeat its scenarios while it is undecided, or failed or skipped by slowed facts."""
        while True:
            runs = [self._scenarios.task_of(scenario) for scenario in criterion.facts]
            facts = [await asyncio.shield(run) for run in runs]
            if runs != [self._scenarios.task_of(scenario) for scenario in criterion.facts]:
                continue  # a scenario was repeated in the meantime
            verdict = criterion.judge(*facts)
            undecided = isinstance(verdict, Undecided)
            repeated = [
                self._scenarios.repeat(scenario, run, alone=undecided)
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

    def _emit_progress(self, scenario: Scenario[Any]) -> None:
        for criterion in self._shown:
            if scenario in criterion.facts and not self._is_judged(criterion):
                progress = self._scenarios.progress_of(criterion.facts, latest=scenario)
                self._on_event(Progress(self._check.exercise, criterion.id, *progress))

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
