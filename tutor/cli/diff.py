"""`ros-tutor diff`: compare the learner's files with the skeleton, or with our solution."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from difflib import unified_diff
from pathlib import Path
from typing import TYPE_CHECKING

from tutor.cli import context, terminal
from tutor.cli.errors import PASSED
from tutor.cli.solution import note_shown

if TYPE_CHECKING:
    from tutor.content import Lesson
    from tutor.judge.submission import Submission
    from tutor.workspace.drawn_cases import Drawn

_COLORS = (("---", "1"), ("+++", "1"), ("@@", "36"), ("-", "31"), ("+", "32"))


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `EXERCISE [PATH] [--solution]`."""
    parser.add_argument("exercise", metavar="EXERCISE", help="for example i2.1")
    parser.add_argument("path", metavar="PATH", nargs="?", type=Path, help="a file or folder (or the workspace's own)")
    parser.add_argument("--solution", action="store_true", help="compare with our solution instead of the skeleton")


def run(arguments: argparse.Namespace) -> int:
    """Print the learner's changes to the skeleton; with --solution, the changes that lead to our solution."""
    from tutor.content.cases import cases_of, read_report
    from tutor.workspace import find_submission, read_source
    from tutor.workspace.drawn_cases import Drawn

    lesson = context.load_course(arguments).find(arguments.exercise)
    workspace = context.require_workspace(arguments)
    submission = find_submission(lesson, arguments.path, workspace)
    drawn = Drawn()
    if (cases := cases_of(lesson)) is not None and (report := submission.files.get(cases.report)) is not None:
        drawn = Drawn((read_report(read_source(report) or "").case,))
    lines = list(_diff_lines(lesson, submission, drawn, solution=arguments.solution))
    other = "our solution" if arguments.solution else "the skeleton"
    if arguments.solution:
        note_shown(workspace, lesson.id)
    if lines:
        terminal.out("\n".join(map(_colorize, lines)) + "\n")
    else:
        terminal.say(f"nothing differs from {other}")
    return PASSED


def _diff_lines(lesson: Lesson, submission: Submission, drawn: Drawn, *, solution: bool) -> Iterator[str]:
    from tutor.workspace import read_source
    from tutor.workspace.drawn_cases import skeleton_text, solution_text

    for file in lesson.files:
        own = submission.files.get(file.name)
        if own is None:
            continue
        ours = (solution_text if solution else skeleton_text)(lesson, file, drawn)
        theirs = (context.display_path(own), (read_source(own) or "").splitlines())
        reference = (f"{'solution' if solution else 'skeleton'}/{file.name}", ours.splitlines())
        (before, old), (after, new) = (theirs, reference) if solution else (reference, theirs)
        yield from unified_diff(old, new, before, after, lineterm="")


def _colorize(line: str) -> str:
    color = next((color for start, color in _COLORS if line.startswith(start)), "")
    return terminal.style(line, color, sys.stdout)
