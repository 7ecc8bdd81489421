"""Grades a class: checks what has no current result yet, and writes each result as soon as it is there."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from hashlib import sha256
from pathlib import Path
from typing import Protocol

from tutor import __version__
from tutor.content import Course, Lesson
from tutor.grade.archives import digest_of, pack
from tutor.grade.machine import COSTS, DEFAULT_COST, Cost
from tutor.grade.results import Result, ResultFolder, Version
from tutor.grade.submissions import Work
from tutor.grade.unit import DEFAULT_LIMIT_S, OnEvent, Outcome, Unit, run_unit
from tutor.judge.result import CriterionResult, Environment, ExerciseResult, Report
from tutor.judge.verdict import Status, Verdict
from tutor.ros.environment import detect

MAX_ATTEMPTS = 2
"""How often a check is made that a fault of the tool or the machine keeps from a verdict."""


class Executor(Protocol):
    """Where checks run."""

    @property
    def slots(self) -> int:
        """How many checks it carries out at once."""

    async def run(self, unit: Unit, on_event: OnEvent) -> Outcome:
        """Carry out one check. `on_event` may not be called for checks on another machine."""


class LocalExecutor:
    """Runs checks on this machine, at most `slots` at once."""

    def __init__(self, slots: int) -> None:
        self._slots = slots

    @property
    def slots(self) -> int:
        """How many checks run at once."""
        return self._slots

    async def run(self, unit: Unit, on_event: OnEvent) -> Outcome:
        """Run one check in a process of its own."""
        return await run_unit(unit, on_event)


class Watcher(Protocol):
    """Is told how grading goes."""

    def started(self, work: Work) -> None:
        """A check begins."""

    def event(self, work: Work) -> OnEvent:
        """Return what to call with the events of a check."""

    def finished(self, result: Result) -> None:
        """A result is written. It may be followed by another one for the same work, if it is an error."""


@dataclass(frozen=True, slots=True)
class Options:
    """How to check. `isolate`: shut submissions off. `limit_s`: for one check. `lessons`: the teacher's own course."""

    isolate: bool = True
    limit_s: float = DEFAULT_LIMIT_S
    lessons: Path | None = None


@dataclass(frozen=True, slots=True)
class Plan:
    """What there is to do. `kept`: results that are current. `missing`: nothing to judge. `todo`: to check."""

    todo: tuple[Work, ...]
    missing: tuple[Work, ...]
    kept: tuple[Result, ...]


class Grading:
    """Grades the work of a class into a folder of results."""

    def __init__(self, course: Course, folder: ResultFolder, executor: Executor, options: Options) -> None:
        self._course = course
        self._folder = folder
        self._executor = executor
        self._options = options
        self._versions: dict[str, Version] = {}

    def plan(self, works: Sequence[Work], *, again: bool = False) -> Plan:
        """Decide what to do. A result is current if submission, course and version are those it was made with."""
        todo, missing, kept = [], [], []
        for work in works:
            result = None if again else self._folder.read(work.learner, work.exercise)
            if not work.files:
                missing.append(work)
            elif result is not None and result.status in ("passed", "failed") and self._is_current(result, work):
                kept.append(replace(result, learner=work.learner))
            else:
                todo.append(work)
        return Plan(tuple(todo), tuple(missing), tuple(kept))

    async def grade(self, plan: Plan, watcher: Watcher, costs: Mapping[str, Cost] = COSTS) -> list[Result]:
        """Carry out a plan; return all results, those that were kept included. No process is left, even if cancelled.

        Long checks come first, so that none of them begins last. Raises StorageError.
        """
        results = [*plan.kept]
        for result in plan.kept:
            self._folder.save(result)  # a roster may have changed what is said of the learner
        for work in plan.missing:
            results.append(self._save(self._missing(work), watcher))
        semaphore = asyncio.Semaphore(self._executor.slots)

        async def check(work: Work) -> Result:
            async with semaphore:
                return await self._check(work, watcher)

        ordered = sorted(plan.todo, key=lambda work: -costs.get(work.exercise, DEFAULT_COST).wall_s)
        tasks = [asyncio.ensure_future(check(work)) for work in ordered]
        try:
            checked = await asyncio.gather(*tasks)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
        for work, result in zip(ordered, checked, strict=True):
            if result.status == "error":  # alone, since the others may be why
                result = await self._check(work, watcher, attempt=MAX_ATTEMPTS)
            results.append(result)
        return results

    async def _check(self, work: Work, watcher: Watcher, attempt: int = 1) -> Result:
        watcher.started(work)
        outcome = await self._run(work, watcher.event(work))
        report = outcome.report or self._fault_report(outcome.fault)
        return self._save(replace(self._result(work, report, attempt), cpu_s=outcome.cpu_s), watcher)

    async def _run(self, work: Work, on_event: OnEvent) -> Outcome:
        files = dict(work.files)
        try:
            packed = await asyncio.to_thread(pack, files)
            if await asyncio.to_thread(digest_of, files) != work.digest:
                return Outcome(None, fault="the files were changed while the class was graded")
        except OSError as error:
            return Outcome(None, fault=f"cannot read {error.filename}: {error.strerror}")
        options = self._options
        key = f"{work.learner.id}/{work.exercise}"
        unit = Unit(key, work.exercise, packed, work.main, options.isolate, options.limit_s, options.lessons)
        return await self._executor.run(unit, on_event)

    def _save(self, result: Result, watcher: Watcher) -> Result:
        self._folder.save(result)
        watcher.finished(result)
        return result

    def _result(self, work: Work, report: Report, attempt: int = 1) -> Result:
        now = datetime.now(UTC).isoformat(timespec="seconds")
        return Result(work.learner, work.exercise, now, work.digest, self._version(work.exercise), report, 0.0, attempt)

    def _is_current(self, result: Result, work: Work) -> bool:
        return result.digest == work.digest and result.version == self._version(work.exercise)

    def _version(self, exercise: str) -> Version:
        if exercise not in self._versions:
            self._versions[exercise] = Version(course_digest(self._course.find(exercise)), __version__)
        return self._versions[exercise]

    def _missing(self, work: Work) -> Result:
        lesson = self._course.find(work.exercise)
        names = ", ".join(file.name for file in lesson.files if file.required)
        verdict = Verdict(Status.SKIPPED, expected=names, cause=work.missing)
        exercise = ExerciseResult(
            id=lesson.id,
            title=lesson.title,
            submission=(),
            criteria=tuple(CriterionResult(text.id, text.text, text.bonus, verdict, 0.0) for text in lesson.criteria),
            duration_s=0.0,
            lookup=work.lookup,
        )
        return self._result(work, Report(_environment(), (exercise,), 0.0))

    def _fault_report(self, message: str) -> Report:
        return Report(_environment(), (), 0.0, message=message)


def _environment() -> Environment:
    ros = detect()
    return Environment(ros_distro=ros.distro, ros=ros.kind, rmw=ros.rmw, ros_tutor=__version__)


def course_digest(lesson: Lesson) -> str:
    """Return a digest of everything that a lesson's verdict depends on: its criteria and the code of its check."""
    check = lesson.check
    folder = check.parent if check.name == "__init__.py" else check
    sources = [*folder.rglob("*")] if folder.is_dir() else [folder]
    sources += [lesson.folder / "lesson.md", *folder.parent.glob("*.py")]
    total = sha256()
    for path in sorted({path for path in sources if path.is_file() and path.suffix != ".pyc"}):
        total.update(f"{path.relative_to(folder.parents[1])}\n".encode() + sha256(path.read_bytes()).digest())
    return total.hexdigest()
