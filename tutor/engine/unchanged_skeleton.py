"""Untouched skeletons: the next step is the first TODO in the file."""

from __future__ import annotations

from dataclasses import replace

from tutor.content import Lesson
from tutor.judge.submission import Submission
from tutor.judge.verdict import Status, Verdict
from tutor.workspace.regular import read_regular


def first_todo(lesson: Lesson, submission: Submission) -> str:
    """The place of the first TODO ("server.py, line 8") if every present file is an untouched skeleton, else ""."""
    todos = []
    for file in lesson.files:
        path = submission.files.get(file.name)
        if path is None:
            continue
        try:
            skeleton = file.skeleton.read_bytes()
            if read_regular(path, len(skeleton)) != skeleton:
                return ""
        except OSError:
            return ""
        text = skeleton.decode("utf-8")
        todos += [f"{file.name}, line {n}" for n, line in enumerate(text.splitlines(), 1) if "TODO" in line]
    return todos[0] if todos else ""


def point_to_todo(verdict: Verdict, todo: str, hint: str) -> Verdict:
    """Point a failed verdict on an untouched skeleton (`todo` is not "") to `todo` and the criterion's `hint`.

    This replaces a step that would give away the code. Other verdicts are returned unchanged.
    """
    if verdict.status is not Status.FAILED or not todo:
        return verdict
    return replace(verdict, step=f"work through the TODOs of the skeleton, from {todo} on. {hint}".strip())
