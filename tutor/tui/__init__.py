"""The terminal app. Textual is imported only when the app opens; rclpy is never imported."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tutor.content.courses import Courses

# The effect of a key press is painted with the next frame; this halves Textual's default frame time of 1/60 s.
# Textual reads the variable when it is imported.
os.environ.setdefault("TEXTUAL_FPS", "120")


def run(workspace: Path, courses: Courses | None = None) -> int:
    """Open the terminal app on a workspace (which need not exist yet) and return its exit code once it is closed.

    `courses`: those to use beside the bundled one, or instead of it. Raises ContentError if a lesson is broken.
    """
    from tutor.tui import key_latency

    key_latency.pause_collection()
    try:
        return _run(workspace, courses)
    finally:
        key_latency.resume_collection()


def _run(workspace: Path, courses: Courses | None) -> int:
    from tutor.content import load_course
    from tutor.content.courses import Courses
    from tutor.session import Session
    from tutor.tui import hangup
    from tutor.tui.app import TutorApp
    from tutor.workspace import Workspace

    hangup.prepare()
    chosen = courses or Courses()
    app = TutorApp(Session(load_course(chosen.folders, only=chosen.only), Workspace(workspace), chosen))
    try:
        app.run()
    finally:
        from tutor.ros import stale_segments  # late: the first paint does not wait for it

        stale_segments.remove()  # left behind by nodes that were killed
    return app.return_code or 0
