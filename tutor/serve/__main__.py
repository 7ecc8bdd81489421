"""The app behind a page: `python -m tutor.serve WORKSPACE [COURSE...] [--only]`, which draws to it, not a terminal."""

from __future__ import annotations

import signal
import sys
from pathlib import Path

from tutor.content.courses import Courses
from tutor.process.prctl import die_with_parent
from tutor.tui import run


def main(workspace: str, *words: str) -> int:
    """Run the app. If the server is killed, the app gets SIGTERM, so that it saves before it exits."""
    die_with_parent(signal.SIGTERM)
    courses = Courses.find((word for word in words if word != "--only"), only="--only" in words)
    return run(Path(workspace), courses)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
