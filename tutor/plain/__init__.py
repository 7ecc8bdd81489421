"""A screen reader's way through the course: lines of text in, lines of text out, and nothing that is drawn."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path


def run(workspace: Path, out: Callable[[str], None], lessons: Path | None = None) -> int:
    """Talk with the learner until they leave; 0, or 130 where they press Ctrl+C. `out` writes to stdout.

    `lessons` is a folder with further `lessons/` and `checks/`. Raises ContentError where a lesson is broken.
    """
    from tutor.content import load_course
    from tutor.plain.dialog import run_dialog
    from tutor.session import Session
    from tutor.workspace import Workspace

    return run_dialog(Session(load_course(lessons), Workspace(workspace), lessons), out)
