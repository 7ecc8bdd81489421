"""Judge what a course brings along, a few at a time: its skeletons, solutions and test submissions, for its author."""

from __future__ import annotations

import asyncio
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path

from tutor.content import Course, Lesson
from tutor.content.patches import write_patched
from tutor.content.submissions import Case, Expected
from tutor.engine.check import run_check
from tutor.engine.leftovers import find_leftovers
from tutor.engine.machine import Limits, prepare
from tutor.errors import SubmissionError
from tutor.judge.result import ExerciseResult
from tutor.judge.submission import Submission
from tutor.workspace import find_submission

MAX_CONCURRENT_CHECKS = 6
"""More than one, since checks mostly wait; not more, since they would only starve each other of CPU time."""


class Kind(StrEnum):
    """What is judged: files of the lesson, or a test submission."""

    SKELETON = "skeleton"
    SOLUTION = "solution"
    SUBMISSION = "submission"


@dataclass(frozen=True, slots=True)
class Job:
    """Something to judge. `case` says what is expected of a test submission."""

    lesson: Lesson
    kind: Kind
    submission: Submission
    case: Case | None = None

    @property
    def name(self) -> str:
        """What is judged, such as "i1.1 skeleton" or "i1.1/wrong/constant"."""
        return str(self.case) if self.case is not None else f"{self.lesson.id} {self.kind}"


@dataclass(frozen=True, slots=True)
class Proof:
    """The result of one job. `left`: the command lines of processes that a submission must not leave behind."""

    job: Job
    result: ExerciseResult
    left: tuple[str, ...] = ()


def jobs_of_lessons(lessons: Sequence[Lesson], scratch: Path) -> Iterator[Job]:
    """Yield all skeletons, then all solutions.

    Skeletons first: they take longest, since a check waits until the timeout for what never comes. Where a skeleton has
    some files of the solution, as what is handed over, its files are put together in `scratch`. Raises OSError.
    """
    for kind in (Kind.SKELETON, Kind.SOLUTION):
        for lesson in lessons:
            files = {file.name: getattr(file, kind.value) for file in lesson.files}
            if kind is Kind.SKELETON and any(file.skeleton == file.solution for file in lesson.files):
                files = _put_together(files, scratch / lesson.folder.name / kind.value)
            yield Job(lesson, kind, Submission(lesson.id, files))


def _put_together(files: Mapping[str, Path], folder: Path) -> dict[str, Path]:
    for name, path in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, folder / name)
    return {name: folder / name for name in files}


def job_of_case(lesson: Lesson, case: Case, scratch: Path) -> Job | None:
    """Return the job of a test submission, or None if files are missing. What a patch makes is put into `scratch`.

    Raises ContentError if a patch does not fit the solution, and OSError.
    """
    folder = case.folder
    if case.changes:
        folder = scratch / lesson.folder.name / case.kind / case.folder.stem
        write_patched(lesson, case.changes, folder)
    try:
        return Job(lesson, Kind.SUBMISSION, find_submission(lesson, folder, None), case)
    except SubmissionError:
        return None


async def prove(jobs: Sequence[Job], course: Course, on_proof: Callable[[Proof], None]) -> list[Proof]:
    """Judge everything, and return the proofs in the order of the jobs.

    Those that keep the CPU busy are judged one at a time, beside the others.
    `on_proof` gets each proof as soon as it is there, in any order. No process that was started is left when this
    returns, is cancelled or raises. Raises EngineError.
    """
    slots, busy = asyncio.Semaphore(MAX_CONCURRENT_CHECKS), asyncio.Lock()
    async with prepare() as prepared:
        machine = replace(prepared, limits=Limits(turn_s=None))

        async def prove_one(job: Job) -> Proof:
            expected = job.case.expected if job.case is not None else Expected("")
            async with busy if expected.keeps_busy else nullcontext(), slots:
                report = await run_check([job.submission], course, machine=machine)
            proof = Proof(job, report.exercises[0], tuple(await find_leftovers(expected.gone)))
            on_proof(proof)
            return proof

        tasks = [asyncio.ensure_future(prove_one(job)) for job in jobs]
        try:
            return list(await asyncio.gather(*tasks))
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
