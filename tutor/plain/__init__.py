"""The course for screen readers: lines of text in, lines of text out, nothing drawn on screen."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tutor.content.courses import Courses


def run(workspace: Path, out: Callable[[str], None], courses: Courses | None = None) -> int:
    """Run the dialog until the learner leaves. Return 0, or 130 after Ctrl+C. `out` writes to stdout.

    `courses`: those to use beside the bundled one, or instead of it. Raises ContentError if a lesson is broken.
    """
    from tutor.content import load_course
    from tutor.content.courses import Courses
    from tutor.plain.dialog import run_dialog
    from tutor.session import Session
    from tutor.workspace import Workspace

    chosen = courses or Courses()
    course = load_course(chosen.folders, only=chosen.only)
    return run_dialog(Session(course, Workspace(workspace), chosen), out)
