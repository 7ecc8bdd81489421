"""Runs the programs of a course's predictions, and proves that exactly one option of each holds."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from typing import TYPE_CHECKING

from tutor.cli import terminal

if TYPE_CHECKING:
    from tutor.content import Lesson, Prediction, Problem
    from tutor.session.predictions import Outcome

_AT_ONCE = 3
"""How many programs run at a time: they wait more than they work."""


def run_programs(lessons: Sequence[Lesson]) -> tuple[int, list[Problem]]:
    """Run each program once, and return how many were run, and what is wrong. Raises Stopped."""
    from tutor.content import Problem
    from tutor.content.places import find_line
    from tutor.content.predictions import FILE
    from tutor.stop_signals import run_until_stopped

    given = [
        (lesson, prediction) for lesson in lessons for prediction in lesson.predictions if prediction.program.is_file()
    ]
    outcomes = run_until_stopped(lambda: _run_all([prediction for _, prediction in given]))
    problems = []
    for (lesson, prediction), outcome in zip(given, outcomes, strict=True):
        if outcome.holds is not None:
            terminal.say(f"{lesson.id} {prediction.id}: {prediction.options[outcome.holds].says}")
            continue
        file = lesson.folder / FILE
        text = f"the prediction {prediction.id}: {outcome.problem}"
        hint = "exactly one option must hold, however busy the machine is"
        problems.append(Problem(file, text, hint, find_line(file, rf"\bid: *{prediction.id}\s*$")))
    return len(given), problems


async def _run_all(predictions: Sequence[Prediction]) -> list[Outcome]:
    from tutor.session.predictions import run_prediction

    turns = asyncio.Semaphore(_AT_ONCE)

    async def run(prediction: Prediction) -> Outcome:
        async with turns:
            return await run_prediction(prediction, lambda state: None)

    return await asyncio.gather(*map(run, predictions))
