"""Runs the skeletons and solutions of lessons, a few at a time, for the author of a course."""

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

AT_ONCE = 6
"""How many checks run at a time: they mostly wait, and more would only starve each other."""


class Kind(StrEnum):
    """What of a lesson is judged."""

    SKELETON = "skeleton"
    SOLUTION = "solution"


@dataclass(frozen=True, slots=True)
class Proof:
    """One skeleton or solution, judged."""

    lesson: Lesson
    kind: Kind
    result: ExerciseResult


async def prove(lessons: Sequence[Lesson], course: Course, on_proof: Callable[[Proof], None]) -> list[Proof]:
    """Judge each lesson's skeleton and solution; the proofs come in the lessons' order, `on_proof` as they come.

    Nothing that was started is left when this returns, is cancelled or raises. Raises EngineError.
    """
    free, start_limiter = asyncio.Semaphore(AT_ONCE), StartLimiter()

    async def one(lesson: Lesson, kind: Kind) -> Proof:
        async with free:
            report = await run_check([_submission(lesson, kind)], course, start_limiter=start_limiter)
        proof = Proof(lesson, kind, report.exercises[0])
        on_proof(proof)
        return proof

    # Skeletons first: a check waits longest for what does not come.
    wanted = [(lesson, kind) for kind in Kind for lesson in lessons]
    tasks = [asyncio.ensure_future(one(*each)) for each in wanted]
    try:
        return list(await asyncio.gather(*tasks))
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


def _submission(lesson: Lesson, kind: Kind) -> Submission:
    return Submission(lesson.id, {file.name: getattr(file, kind.value) for file in lesson.files})
