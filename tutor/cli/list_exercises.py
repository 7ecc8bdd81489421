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

_STATE_LABELS = {
    "passed": ("✓ passed        ", "32"),
    "not_passed": ("✗ not passed yet", "31"),
    "started": ("· started       ", "33"),
    "not_started": ("  not started   ", "2"),
}

_MIN_ID_WIDTH = 6


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `[--format text|json] [--forget COURSE]`."""
    parser.add_argument("--format", choices=("text", "json"), default="text", help="text (default) or json")
    parser.add_argument(
        "--forget", metavar="COURSE", help="first forget a course of the workspace: its name, folder or file"
    )


def run(arguments: argparse.Namespace) -> int:
    """Print one line per exercise, what to do next, and the workspace's ROS domain; or all of it as JSON."""
    workspace = context.require_workspace(arguments)
    if arguments.forget is not None:
        workspace.courses(terminal.say).forget(arguments.forget)
    course = context.load_course(arguments)
    progress = context.read_progress(workspace)
    if arguments.format == "json":
        from tutor.cli.list_json import render

        terminal.out(render(course, progress, workspace))
        return PASSED
    terminal.out(_render_text(course, progress, workspace))
    if not workspace.exists:
        terminal.say(
            f"there is no workspace yet; `{command('start', course.lessons[0].id)}` makes one at {workspace.root}"
        )
    return PASSED


def _render_text(course: Course, progress: Progress, workspace: Workspace) -> str:
    from tutor.content import Counts
    from tutor.workspace import domain_of, states_of

    states = states_of(course.lessons, progress, workspace)
    id_width = max((len(lesson.id) for lesson in course.lessons), default=0)
    id_width = max(id_width, _MIN_ID_WIDTH)
    width = max((len(lesson.title) for lesson in course.lessons), default=0)
    lines: list[str] = []
    for heading in course.headings:
        if len(course.headings) > 1:
            lines += [*([""] if lines else []), heading]
        for beyond in (False, True):
            rows = [
                _render_line(lesson, progress.of(lesson.id), states[lesson.id], id_width, width)
                for lesson in course.lessons
                if lesson.heading == heading and lesson.beyond is beyond
            ]
            lines += [*(["", "Beyond the course"] if beyond and rows else []), *rows]
    counts = Counts.of(course.lessons, [id for id, exercise_state in states.items() if exercise_state.is_passed])
    following = next_lesson(course.lessons, states)
    lead = "Next" if following is not None else "You have done them all"
    lines += ["", f"{counts}. {lead}: {next_command(following, states)}"]
    if workspace.exists:
        lines += [f"Your nodes run in ROS domain {domain_of(workspace)}."]
    return "\n".join(lines) + "\n"


def _render_line(
    lesson: Lesson, progress: ExerciseProgress, exercise_state: ExerciseState, id_width: int, width: int
) -> str:
    state = terminal.style(*_STATE_LABELS[exercise_state.state.value], sys.stdout)
    name = f"{lesson.id:{id_width}} {lesson.title:{width}}  {lesson.difficulty.value:9}"
    return f"{name}  {state}  {_describe_last_attempt(progress, exercise_state)}".rstrip()


def _describe_last_attempt(progress: ExerciseProgress, exercise_state: ExerciseState) -> str:
    last = progress.last
    if last is None:
        return ""
    count = "" if exercise_state.is_passed else f"{exercise_state.count} met, "
    return f"{count}last check {last.verdict.value} ({_format_local_time(last.at)})"


def _format_local_time(at: str) -> str:
    try:
        return f"{datetime.fromisoformat(at).astimezone():%Y-%m-%d %H:%M}"
    except ValueError:
        return at
