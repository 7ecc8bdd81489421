"""The terminal app. Textual is imported only when it is opened; rclpy never is."""

from __future__ import annotations

import os
from pathlib import Path

# What a key changes waits for the next frame: half as long as by default. Textual reads this when it is imported.
os.environ.setdefault("TEXTUAL_FPS", "120")


def run(workspace: Path, lessons: Path | None = None) -> int:
    """Open the terminal app on a workspace (which need not exist yet) and give its exit code when it is closed.

    `lessons` is a folder with further `lessons/` and `checks/`. Raises ContentError where a lesson is broken.
    """
    from tutor.content import load_course
    from tutor.ros import stale_segments
    from tutor.session import Session
    from tutor.tui import hangup
    from tutor.tui.app import TutorApp
    from tutor.workspace import Workspace

    hangup.prepare()
    app = TutorApp(Session(load_course(lessons), Workspace(workspace), lessons))
    try:
        app.run()
    finally:
        stale_segments.remove()  # of nodes that were ended by force
    return app.return_code or 0
