"""`ros-tutor list`: the exercises, with progress."""

from __future__ import annotations

import argparse
import sys
from datetime import datetime
from typing import TYPE_CHECKING

from tutor.cli import context, terminal
from tutor.cli.errors import PASSED
from tutor.invocation import command

if TYPE_CHECKING:
    from tutor.content import Lesson
    from tutor.workspace import ExerciseProgress, Workspace

_WORDS = {"passed": ("✓", "32"), "not passed yet": ("✗", "31"), "started": ("·", "33"), "not started": (" ", "2")}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """It takes none of its own."""


def run(arguments: argparse.Namespace) -> int:
    """Print one line for each exercise, what to do next, and the workspace's ROS domain."""
    from tutor.workspace import domain_of

    course = context.load_course(arguments)
    workspace = context.workspace(arguments)
    progress = context.read_progress(workspace)

    width = max((len(lesson.title) for lesson in course.lessons), default=0)
    words = {lesson.id: _word(lesson, progress.of(lesson.id), workspace) for lesson in course.lessons}
    lines = [_line(lesson, progress.of(lesson.id), words[lesson.id], width) for lesson in course.lessons]
    passed = sum(word == "passed" for word in words.values())
    lines += ["", f"{passed} of {len(lines)} passed.{_next(course.lessons, words)}"]
    if workspace.exists:
        lines += [f"Your nodes run in ROS domain {domain_of(workspace)}."]
    terminal.out("\n".join(lines) + "\n")
    if not workspace.exists:
        terminal.say(
            f"there is no workspace yet; `{command('start', course.lessons[0].id)}` makes one at {workspace.root}"
        )
    return PASSED


def _word(lesson: Lesson, progress: ExerciseProgress, workspace: Workspace) -> str:
    from tutor.workspace import is_started

    if progress.best is not None and progress.best.value == "passed":
        return "passed"
    if progress.attempts:
        return "not passed yet"
    return "started" if progress.started_at or is_started(lesson, None, workspace) else "not started"


def _line(lesson: Lesson, progress: ExerciseProgress, word: str, width: int) -> str:
    mark, color = _WORDS[word]
    state = terminal.style(f"{mark} {word:14}", color, sys.stdout)
    name = f"{lesson.id:6} {lesson.title:{width}}  {lesson.difficulty.value:9}"
    return f"{name}  {state}  {_last(lesson, progress)}".rstrip()


def _last(lesson: Lesson, progress: ExerciseProgress) -> str:
    last = progress.last
    if last is None:
        return ""
    required = last.asked(criterion.id for criterion in lesson.criteria if not criterion.bonus)
    count = f"{sum(criterion in last.passed for criterion in required)} of {len(required)}"
    partly = "" if last.whole else ", some criteria only"
    return f"last check: {last.verdict.value}, {count}{partly} ({_day(last.at)})"


def _day(at: str) -> str:
    try:
        return f"{datetime.fromisoformat(at).astimezone():%Y-%m-%d %H:%M}"
    except ValueError:
        return at


def _next(lessons: tuple[Lesson, ...], words: dict[str, str]) -> str:
    for lesson in lessons:
        if words[lesson.id] == "not started":
            return f" Next: {command('start', lesson.id)}"
        if words[lesson.id] != "passed":
            return f" Next: {command('check', lesson.id)}"
    return f" You have done them all: {command('checklist')}"
