"""Which checklist items a submission shows nothing of, though it passes."""

from __future__ import annotations

from pathlib import Path

import pytest

from tutor.content import load_course
from tutor.engine.explanation import items_not_shown, read_all_sources
from tutor.judge.result import CriterionResult
from tutor.judge.submission import Submission
from tutor.judge.verdict import passed

SUBMISSIONS = Path(__file__).parents[1] / "submissions"
FILES = {"i1.1": "temperature_publisher.py", "i2.1": "parameterized_publisher.py"}


@pytest.mark.parametrize(
    ("exercise", "name", "spins", "not_shown"),
    [
        ("i1.1", "plain-class", True, ()),
        ("i1.1", "helper-modules", True, ()),
        ("i1.1", "no-parameter-services", None, ()),
        ("i1.1", "loop-in-the-constructor", False, ("timers",)),
        ("i1.1", "publishing-thread", True, ("timers",)),
        ("i1.1", "plain-class", False, ("timers",)),  # a timer that nothing spins
        ("i2.1", "plain-class", None, ()),
        ("i2.1", "threading-timer-chain", None, ("timers",)),
    ],
)
def test_a_timer_is_shown_by_a_node_that_makes_one_and_spins(
    exercise: str, name: str, spins: bool | None, not_shown: tuple[str, ...]
) -> None:
    path = SUBMISSIONS / exercise.replace(".", "_") / "right" / name / FILES[exercise]
    (lesson,) = [lesson for lesson in load_course().lessons if lesson.id == exercise]
    criterion = "rate" if exercise == "i1.1" else "timer"
    results = [CriterionResult(criterion, "", False, passed("", "", spins=spins), 1.0)]
    sources = read_all_sources(Submission(exercise, {path.name: path}))
    assert items_not_shown(lesson, sources, results) == not_shown


def test_of_what_cannot_be_read_nothing_is_said() -> None:
    (lesson,) = [lesson for lesson in load_course().lessons if lesson.id == "i1.1"]
    assert items_not_shown(lesson, {}, []) == ()
    assert items_not_shown(lesson, {"node.py": "def ("}, []) == ()
