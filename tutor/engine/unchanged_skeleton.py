"""A skeleton that nobody has begun to fill in: what to do next is in the file itself."""

from __future__ import annotations

from dataclasses import replace

from tutor.content import Lesson
from tutor.judge.submission import Submission
from tutor.judge.verdict import Status, Verdict
from tutor.workspace.regular import read_regular


def first_todo(lesson: Lesson, submission: Submission) -> str:
    """Where the first TODO is ("server.py, line 8"), if every file is still as the lesson gave it; empty where not."""
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
    """A failed verdict on such a skeleton, with the criterion's hint as the next step, instead of the code itself."""
    if verdict.status is not Status.FAILED or not todo:
        return verdict
    return replace(verdict, hint=f"work through the TODOs of the skeleton, from {todo} on. {hint}".strip())
