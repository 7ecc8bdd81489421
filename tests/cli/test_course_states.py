"""Which exercise `list` and `next` name as the next one."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tutor.cli.course_states import next_lesson
from tutor.content import load_course
from tutor.workspace.exercise_states import exercise_state
from tutor.workspace.progress import ExerciseProgress

OURS = load_course().lessons[:2]
LAMPS = tuple(replace(lesson, id=f"x{lesson.id[1:]}", course="lamps") for lesson in OURS)


@pytest.mark.parametrize(
    ("started", "following"),
    [
        ((), "i1.1"),
        (("i1.2",), "i1.1"),
        (("x1.2",), "x1.1"),
        (("x1.1", "i1.2"), "i1.1"),
    ],
)
def test_a_course_that_has_been_started_comes_first(started: tuple[str, ...], following: str) -> None:
    lessons = (*OURS, *LAMPS)
    states = {
        lesson.id: exercise_state(lesson, ExerciseProgress(), has_files=lesson.id in started) for lesson in lessons
    }
    found = next_lesson(lessons, states)
    assert found is not None
    assert found.id == following


def test_what_goes_beyond_a_course_comes_last() -> None:
    lessons = (*(replace(lesson, beyond=True) for lesson in OURS), *LAMPS)
    states = {lesson.id: exercise_state(lesson, ExerciseProgress(), has_files=True) for lesson in lessons}
    found = next_lesson(lessons, states)
    assert found is not None
    assert found.id == "x1.1"
