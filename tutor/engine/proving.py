"""Check the skeletons and solutions of lessons, a few at a time, for the author of a course."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum

from tutor.content import Course, Lesson
from tutor.engine.check import run_check
from tutor.engine.start_limiter import StartLimiter
from tutor.judge.result import ExerciseResult
from tutor.judge.submission import Submission

MAX_CONCURRENT_CHECKS = 6
"""More than one, since checks mostly wait; not more, since they would only starve each other of CPU time."""


class Kind(StrEnum):
    """Which of a lesson's files are judged."""

    SKELETON = "skeleton"
    SOLUTION = "solution"


@dataclass(frozen=True, slots=True)
class Proof:
    """The result for one skeleton or solution."""

    lesson: Lesson
    kind: Kind
    result: ExerciseResult


async def prove(lessons: Sequence[Lesson], course: Course, on_proof: Callable[[Proof], None]) -> list[Proof]:
    """Judge each lesson's skeleton and solution: all skeletons first, then all solutions, each in the lessons' order.

    `on_proof` gets each proof as soon as it is there, in any order. No process that was started is left when this
    returns, is cancelled or raises. Raises EngineError.
    """
    slots, start_limiter = asyncio.Semaphore(MAX_CONCURRENT_CHECKS), StartLimiter()

    async def prove_one(lesson: Lesson, kind: Kind) -> Proof:
        async with slots:
            report = await run_check([_submission(lesson, kind)], course, start_limiter=start_limiter)
        proof = Proof(lesson, kind, report.exercises[0])
        on_proof(proof)
        return proof

    # Skeletons first: they take longest, since a check waits until the timeout for what never comes.
    wanted = [(lesson, kind) for kind in Kind for lesson in lessons]
    tasks = [asyncio.ensure_future(prove_one(*each)) for each in wanted]
    try:
        return list(await asyncio.gather(*tasks))
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


def _submission(lesson: Lesson, kind: Kind) -> Submission:
    return Submission(lesson.id, {file.name: getattr(file, kind.value) for file in lesson.files})
