"""Predictions in the app: the question, the program that runs, what was seen, and the checklist."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import pytest

from tests.tui import fakes
from tests.tui.conftest import Learner
from tutor.content import Prediction, load_course
from tutor.judge.trace import OutputLine
from tutor.session import predictions
from tutor.session.node import NodeState, Phase
from tutor.session.predictions import Outcome
from tutor.tui.dialogs.predict import PredictScreen

SIZES = [(120, 36), (80, 24)]
TOPICS = next(lesson.id for lesson in load_course().lessons if any(p.id == "nobody-there" for p in lesson.predictions))


class FakeRun:
    """Stands for the programs: writes a line, and ends with the outcome once `end` is called."""

    def __init__(self) -> None:
        self.running: list[str] = []
        self.ended = asyncio.Event()
        self.outcome = Outcome(None, "it is not known")

    async def __call__(self, prediction: Prediction, show: Callable[[NodeState], object]) -> Outcome:
        self.running.append(prediction.id)
        self.ended.clear()
        line = OutputLine("stdout", f"a line of {prediction.program.name}", 0.0)
        show(NodeState(prediction.program.name, Phase.RUNNING, 0.0, lines=(line,)))
        try:
            await self.ended.wait()
            return self.outcome
        finally:
            self.running.remove(prediction.id)

    def end(self, holds: int | None, problem: str = "") -> None:
        self.outcome = Outcome(holds, problem)
        self.ended.set()


@pytest.fixture
def program(monkeypatch: pytest.MonkeyPatch) -> FakeRun:
    monkeypatch.setattr(fakes, "course", lambda folder: load_course())
    fake = FakeRun()
    monkeypatch.setattr(predictions, "run_prediction", fake)
    return fake


async def open_predictions(me: Learner, exercise: str) -> None:
    await me.sees("6 Checklist")
    lesson = me.session.course.find(exercise)
    await asyncio.to_thread(me.session.start, lesson)
    await me.main.go_to(lesson)
    await me.sees(f"8 Predict what {len(lesson.predictions)} given programs do, then see")
    await me.press("8")
    await me.until(lambda: isinstance(me.app.screen, PredictScreen), "opened")


@pytest.mark.parametrize("size", SIZES)
async def test_answer_run_and_see(learner: Any, program: FakeRun, size: Any) -> None:
    async with learner(size) as me:
        await me.press("8")
        assert not isinstance(me.app.screen, PredictScreen)  # i1.1 has nothing to predict
        await open_predictions(me, "i2.3")
        await me.sees("I2.3: predict and see, 1 of 5, not answered yet", '"""Two timers in one node. The executor')
        await me.sees("No callback group is named here.", "1  one at a time", "3  four, one for each thread")
        await me.sees("1-3 answers", "Esc closes")
        await me.press("pagedown", "pagedown", "pagedown")
        await me.sees("rclpy.try_shutdown()")
        await me.press("4", "2")  # there is no fourth option
        await me.sees("▸ 2  two, one for each timer", "│ a line of two_timers.py", "Esc ends it")
        await me.press("1", "n")  # answered is answered
        await me.sees("▸ 2  two, one for each timer")
        program.end(0)
        await me.sees("✗ Not so. Both timers are in the node's default group", "✓ 1  one at a time", "✗ 2  two")
        await me.sees("1 of 5, not right yet")

        await me.press("n")
        await me.sees("2 of 5, not answered yet", "Each timer has a mutually exclusive group of its own.")
        await me.press("down", "enter")
        await me.sees("▸ 2  two, one for each group")
        program.end(1)
        await me.sees("✓ Right. Callbacks of different groups may overlap", "2 of 5, right")

        await me.press("p", "1")
        await me.sees("▸ 1  one at a time")
        program.end(0)
        await me.sees("1 of 5, right, after its outcome was seen")
        await me.press("escape")
        found = me.session.progress().of("i2.3").predictions
        assert {id: (answer.right, answer.seen) for id, answer in found.items()} == {
            "no-group-named": (True, True),
            "two-groups": (True, False),
        }
        await me.press("8")
        await me.sees("3 of 5, not answered yet")


async def test_closing_ends_the_program_and_records_nothing(learner: Any, program: FakeRun) -> None:
    async with learner() as me:
        await open_predictions(me, "i2.3")
        await me.press("1")
        await me.until(lambda: program.running == ["no-group-named"], "it runs")
        await me.press("escape")
        await me.until(lambda: not program.running, "it is ended")
        await me.pilot.click("#lesson-head", offset=(6, 2))  # the line that says so opens them, too
        await me.until(lambda: isinstance(me.app.screen, PredictScreen), "opened")
        await me.press("1")
        await me.sees("▸ 1  one at a time")
        program.end(None, "two_timers.py has not ended within 90 s")
        await me.sees("! Nothing is recorded, as two_timers.py has not ended within 90 s.", "1-3 answers")
        assert me.session.progress().of("i2.3").predictions == {}
        await me.press("1")
        program.end(0)
        await me.sees("✓ Right. ")
        assert not me.session.progress().of("i2.3").predictions["no-group-named"].seen


async def test_the_checklist_shows_what_came_true(learner: Any, program: FakeRun) -> None:
    async with learner((180, 48)) as me:
        await me.press("6")
        await me.sees(f"○ not yet shown by {TOPICS} predictions")
        await me.press("escape")
        await open_predictions(me, TOPICS)
        for holds in (1, 0, 1, 2):
            await me.press(str(holds + 1))
            await me.until(lambda: bool(program.running), "it runs")
            program.end(holds)
            await me.sees("✓ Right. ")
            await me.press("enter")
        await me.until(lambda: not isinstance(me.app.screen, PredictScreen), "closed after the last")
        await me.press("6")
        await me.sees(f"✓ {TOPICS} predictions passed, today", "1 shown by your checks")
