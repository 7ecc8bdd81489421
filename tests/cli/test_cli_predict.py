"""`ros-tutor predict`: the list, the question, and what was seen."""

from __future__ import annotations

import io
import sys
from pathlib import Path

import pytest

from tests.cli.conftest import Run
from tutor.content import load_course
from tutor.session import predictions
from tutor.session.predictions import Outcome
from tutor.workspace import Workspace

WITH_SOME = [lesson.id for lesson in load_course().lessons if lesson.predictions]
TOPICS = next(lesson.id for lesson in load_course().lessons if any(p.id == "nobody-there" for p in lesson.predictions))


@pytest.fixture
def seen(monkeypatch: pytest.MonkeyPatch) -> list[Outcome]:
    """What the next programs show; none is run."""
    outcomes: list[Outcome] = []

    async def run_prediction(*_: object) -> Outcome:
        return outcomes.pop(0)

    monkeypatch.setattr(predictions, "run_prediction", run_prediction)
    return outcomes


def answers(home: Path, exercise: str = "i2.3") -> dict[str, tuple[bool, bool]]:
    progress = Workspace(home / "ros_tutor_ws").progress().read()
    return {id: (found.right, found.seen) for id, found in progress.of(exercise).predictions.items()}


def test_a_real_program_is_run_and_judges(run: Run, home: Path) -> None:
    run("start", "i2.3")
    result = run("predict", "i2.3", "reentrant", "--answer", "2")
    assert result.code == 1, result.err
    assert "class ReentrantTimers(Node):" in result.out
    assert "  1  one at a time\n" in result.out
    assert "  | callbacks at the same time: 4\n" in result.out
    assert "Not so. What was seen: four, one for each thread (3).\n\nIn a reentrant group," in result.out
    assert answers(home) == {"reentrant": (False, False)}
    assert "3  reentrant           not right yet" in run("predict", "i2.3").out


def test_all_right_is_evidence(run: Run, home: Path, seen: list[Outcome]) -> None:
    run("start", TOPICS)
    for number, outcome in enumerate((1, 0, 1, 2), 1):
        assert f"{TOPICS} predictions" not in run("checklist").out
        seen.append(Outcome(outcome))
        result = run("predict", TOPICS, number, "--answer", outcome + 1)
        assert (result.code, "Right. What was seen: " in result.out) == (0, True)
    assert f"when a service is  ({TOPICS} predictions passed, today)" in run("checklist").out
    assert "4  who-waits     right\n" in run("predict", TOPICS).out


def test_an_answer_is_asked_for_until_there_is_one(
    run: Run, home: Path, seen: list[Outcome], monkeypatch: pytest.MonkeyPatch
) -> None:
    run("start", "i2.3")
    seen += [Outcome(0), Outcome(0)]
    monkeypatch.setattr(sys, "stdin", io.StringIO("x\n4\n3\n"))
    result = run("predict", "I2.3", "no-group-named")
    assert result.out.count("Your answer, 1 to 3: ") == 3
    assert (result.code, answers(home)) == (1, {"no-group-named": (False, False)})
    monkeypatch.setattr(sys, "stdin", io.StringIO("1\n"))
    assert run("predict", "i2.3", "1").code == 0
    assert answers(home) == {"no-group-named": (True, True)}
    assert "right, after its outcome was seen" in run("predict").out
    monkeypatch.setattr(sys, "stdin", io.StringIO(""))
    result = run("predict", "i2.3", "1")
    assert (result.code, "nothing was run" in result.err) == (2, True)


def test_nothing_is_recorded_if_nothing_can_be_told(run: Run, home: Path, seen: list[Outcome]) -> None:
    run("start", "i2.3")
    seen.append(Outcome(None, "two_timers.py has not ended within 90 s"))
    result = run("predict", "i2.3", "1", "--answer", "1")
    assert result.code == 3
    assert "nothing is recorded, as two_timers.py has not ended within 90 s" in result.err
    assert "Right" not in result.out
    assert answers(home) == {}


def test_without_a_workspace_it_says_that_nothing_is_kept(run: Run, home: Path, seen: list[Outcome]) -> None:
    seen.append(Outcome(0))
    result = run("predict", "i2.3", "1", "--answer", "1")
    assert result.code == 0
    assert "your answer is not kept; `ros-tutor start i2.3` makes one" in result.err
    assert list(home.iterdir()) == []


def test_the_list_names_the_next_one(run: Run, seen: list[Outcome]) -> None:
    assert f"To answer one: ros-tutor predict {WITH_SOME[0]} " in run("predict").out
    assert "To answer one: ros-tutor predict i2.3 no-group-named\n" in run("predict", "i2.3").out
    run("start", "i2.3")
    seen.append(Outcome(0))
    run("predict", "i2.3", "1", "--answer", "1")
    assert "To answer one: ros-tutor predict i2.3 two-groups\n" in run("predict", "i2.3").out


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["i1.1"], f"i1.1 has nothing to predict; {' and '.join(WITH_SOME)} have some"),
        (["i9.9"], "i9.9"),
        (["i2.3", "groups"], "i2.3 has no prediction 'groups'; it has no-group-named, two-groups, "),
        (["i2.3", "1", "--answer", "4"], "--answer 4: the answers go from 1 to 3"),
        (["i2.3", "--answer", "1"], "--answer needs EXERCISE and ID"),
    ],
)
def test_wrong_usage(run: Run, argv: list[str], message: str) -> None:
    result = run("predict", *argv)
    assert (result.code, message in result.err) == (2, True), result.err
