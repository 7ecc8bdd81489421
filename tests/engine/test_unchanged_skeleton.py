"""The next step for an unchanged skeleton is where to begin, not the code that the exercise asks for."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.failures import failure
from tutor.content import Lesson, load_course
from tutor.engine.explanation import first_todo, point_to_todo
from tutor.judge.submission import Submission
from tutor.judge.verdict import passed

LESSONS = load_course().lessons


@pytest.mark.parametrize("lesson", LESSONS, ids=[lesson.id for lesson in LESSONS])
def test_an_untouched_skeleton_has_a_first_todo_until_it_is_changed(lesson: Lesson, tmp_path: Path) -> None:
    files = {file.name: tmp_path / file.name for file in lesson.files if file.skeleton.is_file()}
    for file in lesson.files:
        (tmp_path / file.name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file.skeleton, tmp_path / file.name)
    submission = Submission(lesson.id, files)
    todo = first_todo(lesson, submission)
    name, _, line = todo.partition(", line ")
    assert "TODO" in files[name].read_text().splitlines()[int(line) - 1]
    with files[name].open("a") as begun:
        begun.write("# mine\n")
    assert first_todo(lesson, submission) == ""


def test_an_untouched_skeletons_next_step_is_the_criterions_hint() -> None:
    verdict = failure("a", "b", ("no publisher", "there is none", "line 3 becomes: all of it"))
    pointed = point_to_todo(verdict, "node.py, line 8", "Create a publisher.")
    assert pointed.step == "work through the TODOs of the skeleton, from node.py, line 8 on. Create a publisher."
    assert (pointed.cause, pointed.status) == (verdict.cause, verdict.status)
    assert point_to_todo(verdict, "", "Create a publisher.") == verdict
    assert point_to_todo(passed("a", "b"), "node.py, line 8", "x") == passed("a", "b")
