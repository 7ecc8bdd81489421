"""`ros-tutor list`: the exercises, with progress."""

from __future__ import annotations

import argparse
import sys
from datetime import datetime
from typing import TYPE_CHECKING

from tutor.cli import context, terminal
from tutor.cli.course_states import next_command, next_lesson
from tutor.cli.errors import PASSED
from tutor.invocation import command

if TYPE_CHECKING:
    from tutor.content import Course, Lesson
    from tutor.workspace import ExerciseProgress, ExerciseState, Progress, Workspace

_WORDS = {
    "passed": ("✓ passed        ", "32"),
    "not_passed": ("✗ not passed yet", "31"),
    "started": ("· started       ", "33"),
    "not_started": ("  not started   ", "2"),
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[--format text|json]."""
    parser.add_argument("--format", choices=("text", "json"), default="text", help="text (default) or json")


def run(arguments: argparse.Namespace) -> int:
    """Print one line for each exercise, what to do next, and the workspace's ROS domain; or all of it as JSON."""
    course = context.load_course(arguments)
    workspace = context.require_workspace(arguments)
    progress = context.read_progress(workspace)
    if arguments.format == "json":
        from tutor.cli.list_json import render

        terminal.out(render(course, progress, workspace))
        return PASSED
    terminal.out(_text(course, progress, workspace))
    if not workspace.exists:
        terminal.say(
            f"there is no workspace yet; `{command('start', course.lessons[0].id)}` makes one at {workspace.root}"
        )
    return PASSED


def _text(course: Course, progress: Progress, workspace: Workspace) -> str:
    from tutor.workspace import domain_of, states_of

    known = states_of(course.lessons, progress, workspace)
    width = max((len(lesson.title) for lesson in course.lessons), default=0)
    lines = [_line(lesson, progress.of(lesson.id), known[lesson.id], width) for lesson in course.lessons]
    passed = sum(exercise_state.is_passed for exercise_state in known.values())
    following = next_lesson(course.lessons, known)
    word = "Next" if following is not None else "You have done them all"
    lines += ["", f"{passed} of {len(lines)} passed. {word}: {next_command(following, known)}"]
    if workspace.exists:
        lines += [f"Your nodes run in ROS domain {domain_of(workspace)}."]
    return "\n".join(lines) + "\n"


def _line(lesson: Lesson, progress: ExerciseProgress, exercise_state: ExerciseState, width: int) -> str:
    state = terminal.style(*_WORDS[exercise_state.state.value], sys.stdout)
    name = f"{lesson.id:6} {lesson.title:{width}}  {lesson.difficulty.value:9}"
    return f"{name}  {state}  {_last(progress, exercise_state)}".rstrip()


def _last(progress: ExerciseProgress, exercise_state: ExerciseState) -> str:
    last = progress.last
    if last is None:
        return ""
    count = "" if exercise_state.is_passed else f"{exercise_state.count} met, "
    return f"{count}last check {last.verdict.value} ({_day(last.at)})"


def _day(at: str) -> str:
    try:
        return f"{datetime.fromisoformat(at).astimezone():%Y-%m-%d %H:%M}"
    except ValueError:
        return at
