"""The terminal app. Textual is imported only when the app opens; rclpy is never imported."""

from __future__ import annotations

import os
from pathlib import Path

# The effect of a key press is painted with the next frame; this halves Textual's default frame time of 1/60 s.
# Textual reads the variable when it is imported.
os.environ.setdefault("TEXTUAL_FPS", "120")


def run(workspace: Path, lessons: Path | None = None) -> int:
    """Open the terminal app on a workspace (which need not exist yet) and return its exit code once it is closed.

    `lessons` is a folder with additional `lessons/` and `checks/`. Raises ContentError if a lesson is broken.
    """
    from tutor.tui import key_latency

    key_latency.pause_collection()
    try:
        return _run(workspace, lessons)
    finally:
        key_latency.resume_collection()


def _run(workspace: Path, lessons: Path | None) -> int:
    from tutor.content import load_course
    from tutor.session import Session
    from tutor.tui import hangup
    from tutor.tui.app import TutorApp
    from tutor.workspace import Workspace

    hangup.prepare()
    app = TutorApp(Session(load_course(lessons), Workspace(workspace), lessons))
    try:
        app.run()
    finally:
        from tutor.ros import stale_segments  # late: the first paint does not wait for it

        stale_segments.remove()  # left behind by nodes that were killed
    return app.return_code or 0
