"""The course for screen readers: lines of text in, lines of text out, nothing drawn on screen."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path


def run(workspace: Path, out: Callable[[str], None], lessons: Path | None = None) -> int:
    """Run the dialog until the learner leaves. Return 0, or 130 after Ctrl+C. `out` writes to stdout.

    `lessons` is a folder with additional `lessons/` and `checks/`. Raises ContentError if a lesson is broken.
    """
    from tutor.content import load_course
    from tutor.plain.dialog import run_dialog
    from tutor.session import Session
    from tutor.workspace import Workspace

    return run_dialog(Session(load_course(lessons), Workspace(workspace), lessons), out)
