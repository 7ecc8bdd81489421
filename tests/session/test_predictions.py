"""The program of a prediction is run, and what it has written decides."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

import pytest

from tutor.content import Option, Prediction, load_course
from tutor.session import predictions
from tutor.session.node import NodeState
from tutor.session.predictions import Outcome, run_prediction
from tutor.workspace import Predicted

ALL = [
    pytest.param(prediction, id=f"{lesson.id} {prediction.id}")
    for lesson in load_course().lessons
    for prediction in lesson.predictions
]


@pytest.fixture
def ask(tmp_path: Path) -> Callable[..., Prediction]:
    def ask(program: str) -> Prediction:
        file = tmp_path / "wheels.py"
        file.write_text(program)
        options = (Option("one", "turning: 1$"), Option("two", "turning: 2$"))
        return Prediction("wheels", file, "How many?", options, "Because.")

    return ask


@pytest.mark.parametrize(
    ("program", "outcome"),
    [
        ("print('turning: 2')", Outcome(1)),
        ("import sys; print('turning: 1', file=sys.stderr)", Outcome(0)),
        (
            "print('turning: 1'); print('turning: 2')",
            Outcome(None, "2 options can be told from what wheels.py has written"),
        ),
        ("print('hello')", Outcome(None, "none of the options can be told from what wheels.py has written")),
        ("print('turning: 2'); raise SystemExit(3)", Outcome(None, "wheels.py ended by itself with exit code 3")),
    ],
)
async def test_exactly_one_option_must_hold(ask: Callable[..., Prediction], program: str, outcome: Outcome) -> None:
    states: list[NodeState] = []
    assert await run_prediction(ask(program), states.append) == outcome
    assert not states[-1].alive


async def test_a_program_that_does_not_end_is_ended(
    ask: Callable[..., Prediction], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(predictions, "LIMIT_S", 3.0)
    outcome = await run_prediction(ask("import threading; threading.Event().wait()"), lambda state: None)
    assert outcome == Outcome(None, "wheels.py has not ended within 3 s")


async def test_it_is_ended_when_nobody_wants_to_know_any_more(ask: Callable[..., Prediction]) -> None:
    written = asyncio.Event()

    def show(state: NodeState) -> None:
        if state.lines:
            written.set()

    program = "import threading; print('turning: 1', flush=True); threading.Event().wait()"
    run = asyncio.create_task(run_prediction(ask(program), show))
    await written.wait()
    run.cancel()
    with pytest.raises(asyncio.CancelledError):
        await run


@pytest.mark.parametrize("prediction", ALL)
async def test_one_option_of_each_of_ours_holds(prediction: Prediction) -> None:
    outcome = await run_prediction(prediction, lambda state: None)
    assert outcome.holds is not None, outcome.problem


def test_standing_in_words() -> None:
    at = "2026-01-02T12:00:00Z"
    assert [
        predictions.standing(answer)
        for answer in (None, Predicted(at, False), Predicted(at, True), Predicted(at, True, seen=True))
    ] == ["not answered yet", "not right yet", "right", "right, after its outcome was seen"]
