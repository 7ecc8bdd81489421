"""Grades a class: checks what has no current result yet, and writes each result as soon as it is there."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Protocol

from tutor import __version__
from tutor.content import Course, Lesson
from tutor.content.cases import FILE as CASES
from tutor.content.cases import has_cases
from tutor.grade.capacity import COSTS, DEFAULT_COST, Cost
from tutor.grade.results import Result, ResultFolder, Version, encode
from tutor.grade.submission_files import digest_of, pack
from tutor.grade.unit import DEFAULT_LIMIT_S, OnEvent, Outcome, Unit, run_unit
from tutor.grade.work import Work
from tutor.judge.result import Environment, Report
from tutor.judge.verdict import Status
from tutor.ros.environment import detect
from tutor.workspace import missing_result

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
    """What there is to do. `kept`: results that are current. `missing`: nothing to judge. `todo`: to check.

    `renamed`: those of `kept` whose learner was known by another name, or had another row in the roster.
    """

    todo: tuple[Work, ...]
    missing: tuple[Work, ...]
    kept: tuple[Result, ...]
    renamed: tuple[Result, ...] = ()


class Grading:
    """Grades the work of a class into a folder of results."""

    def __init__(self, course: Course, folder: ResultFolder) -> None:
        self._course = course
        self._folder = folder
        self._versions: dict[str, Version] = {}

    def plan(self, works: Sequence[Work], *, again: bool = False) -> Plan:
        """Decide what to do. A result is current if submission, course and version are those it was made with."""
        todo, missing, kept, renamed = [], [], [], []
        for work in works:
            result = None if again else self._folder.read(work.learner, work.exercise)
            if work.missing:
                missing.append(work)
            elif work.fault or result is None or not self._is_current(result, work):
                todo.append(work)
            else:
                kept.append(replace(result, learner=work.learner))
                if result.learner != work.learner:
                    renamed.append(kept[-1])
        return Plan(tuple(todo), tuple(missing), tuple(kept), tuple(renamed))

    async def grade(
        self,
        plan: Plan,
        executor: Executor,
        options: Options,
        watcher: Watcher,
        costs: Mapping[str, Cost] = COSTS,
    ) -> list[Result]:
        """Carry out a plan; return all results, those that were kept included. No process is left, even if cancelled.

        Long checks come first, so that none of them begins last. Raises StorageError.
        """
        results = [*plan.kept]
        for result in plan.renamed:
            self._folder.save(result)
        for work in plan.missing:
            results.append(self._save_missing(work, watcher))
        semaphore = asyncio.Semaphore(executor.slots)

        async def check(work: Work, attempt: int = 1) -> Result:
            async with semaphore:
                watcher.started(work)
                outcome = await _run(work, executor, options, watcher.event(work))
                report = outcome.report or Report(_environment(), (), 0.0, message=outcome.fault)
                return self._save(replace(self._result(work, report, attempt), cpu_s=outcome.cpu_s), watcher)

        ordered = sorted(plan.todo, key=lambda work: -costs.get(work.exercise, DEFAULT_COST).wall_s)
        tasks = [asyncio.ensure_future(check(work)) for work in ordered]
        try:
            checked = await asyncio.gather(*tasks)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
        for work, result in zip(ordered, checked, strict=True):
            if result.unjudged:  # alone, since the others may be why
                repeated = await check(work, MAX_ATTEMPTS)
                if repeated.status != "error" or result.status == "error":
                    result = repeated
                else:  # only a bonus was unjudged the first time
                    result = self._save(replace(result, attempt=MAX_ATTEMPTS), watcher)
            results.append(result)
        for result in results:
            self._restore(result)
        return results

    def _restore(self, result: Result) -> None:
        """Write a result again if its file is another one by now: a submission that is not isolated can change it."""
        found = self._folder.read(result.learner, result.exercise)
        if found is None or encode(found) != encode(result):
            self._folder.save(result)

    def _save(self, result: Result, watcher: Watcher) -> Result:
        self._folder.save(result)
        watcher.finished(result)
        return result

    def _save_missing(self, work: Work, watcher: Watcher) -> Result:
        result, before = self._missing(work), self._folder.read(work.learner, work.exercise)
        if before is not None and encode(replace(before, graded_at=result.graded_at)) == encode(result):
            result = before  # nothing has changed since, so neither does the file
            watcher.finished(result)
            return result
        return self._save(result, watcher)

    def _result(self, work: Work, report: Report, attempt: int = 1) -> Result:
        now = datetime.now(UTC).isoformat(timespec="seconds")
        return Result(work.learner, work.exercise, now, work.digest, self._version(work.exercise), report, 0.0, attempt)

    def _is_current(self, result: Result, work: Work) -> bool:
        made_with = (result.digest, result.version)
        return not result.unjudged and made_with == (work.digest, self._version(work.exercise))

    def _version(self, exercise: str) -> Version:
        if exercise not in self._versions:
            self._versions[exercise] = Version(course_digest(self._course.find(exercise)), __version__)
        return self._versions[exercise]

    def _missing(self, work: Work) -> Result:
        exercise = missing_result(self._course.find(work.exercise), Status.SKIPPED, work.missing, work.lookup)
        return self._result(work, Report(_environment(), (exercise,), 0.0))


async def _run(work: Work, executor: Executor, options: Options, on_event: OnEvent) -> Outcome:
    if work.fault:
        return Outcome(None, fault=work.fault)
    try:
        packed, digest = await asyncio.to_thread(pack, work.files)
    except OSError as error:
        return Outcome(None, fault=f"{error.filename} cannot be read: {error.strerror}")
    if digest != work.digest:
        return Outcome(None, fault="the files were changed while the class was graded")
    key = f"{work.learner.id}/{work.exercise}"
    unit = Unit(key, work.exercise, packed, work.main, options.isolate, options.limit_s, options.lessons)
    return await executor.run(unit, on_event)


def _environment() -> Environment:
    return detect().for_report()


def course_digest(lesson: Lesson) -> str:
    """Return a digest of what a lesson's verdict depends on: its criteria and skeleton, and the code of its check."""
    check = lesson.check
    code = check.parent if check.name == "__init__.py" else check
    files = {"lesson.md": lesson.folder / "lesson.md"}
    files |= {f"skeleton/{file.name}": file.skeleton for file in lesson.files}
    files |= {CASES: lesson.folder / CASES} if has_cases(lesson) else {}
    for top in (code, code.parent / "__init__.py"):
        below = top.rglob("*") if top.is_dir() else (top,)
        files |= {f"checks/{path.relative_to(code.parent)}": path for path in below if path.is_file()}
    return digest_of({name: path for name, path in files.items() if "__pycache__" not in path.parts})
