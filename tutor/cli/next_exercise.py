"""`ros-tutor next`: the first exercise that is not passed, and what to do."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from tutor.cli import context, terminal
from tutor.cli.course_states import next_command, next_lesson
from tutor.cli.errors import PASSED
from tutor.invocation import command

if TYPE_CHECKING:
    from tutor.content import Lesson
    from tutor.workspace import ExerciseState, Workspace


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add nothing: `next` takes no arguments."""


def run(arguments: argparse.Namespace) -> int:
    """Print the exercise, the learner's progress on it, and the next command."""
    from tutor.content import Counts
    from tutor.workspace import states_of

    course = context.load_course(arguments)
    workspace = context.require_workspace(arguments)
    progress = context.read_progress(workspace)
    states = states_of(course.lessons, progress, workspace)
    lesson = next_lesson(course.lessons, states)
    if lesson is None:
        terminal.out(f"You have passed all {len(states)} exercises.\nNext: {next_command(None, states)}\n")
        return PASSED
    heading = f"{lesson.id} {lesson.title} ({lesson.difficulty.value})"
    counts = Counts.of(course.lessons, [id for id, exercise_state in states.items() if exercise_state.is_passed])
    lines = [terminal.style(heading, "1", sys.stdout), lesson.objective.strip(), ""]
    if lesson.beyond and counts.course_done:
        lines = [f"You have passed all {counts.total} exercises of the course. Beyond it:", "", *lines]
    if states[lesson.id].is_started:
        lines += _progress_lines(lesson, states[lesson.id], workspace)
    lines += [f"Next: {next_command(lesson, states)}"]
    terminal.out(terminal.wrap("\n".join(lines), terminal.width(sys.stdout)))
    return PASSED


def _progress_lines(lesson: Lesson, exercise_state: ExerciseState, workspace: Workspace) -> list[str]:
    lines = [f"  to edit   {context.display_path(workspace.path_of(file.name))}" for file in lesson.files]
    if exercise_state.is_attempted:
        lines += [f"  not yet   {', '.join(exercise_state.missed)}"] if exercise_state.missed else []
        lines += [f"  a hint    {command('hint', lesson.id)}"]
    return [*lines, f"  to run    {command('run', lesson.id)}", ""]
