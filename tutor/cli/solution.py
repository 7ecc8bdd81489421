"""`ros-tutor solution`: print our solution."""

from __future__ import annotations

import argparse

from tutor.cli import context, terminal
from tutor.cli.errors import PASSED


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `EXERCISE`."""
    parser.add_argument("exercise", metavar="EXERCISE", help="for example i2.1")


def run(arguments: argparse.Namespace) -> int:
    """Print the files; if there are several, each below a comment with its name."""
    lesson = context.load_course(arguments).find(arguments.exercise)
    texts = []
    for file in lesson.files:
        text = file.solution.read_text(encoding="utf-8").rstrip("\n") + "\n"
        texts.append(f"# --- {file.name} ---\n{text}" if len(lesson.files) > 1 else text)
    terminal.out("\n\n".join(texts))
    return PASSED
