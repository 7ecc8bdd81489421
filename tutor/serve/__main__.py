"""The app behind one page: `python -m tutor.serve WORKSPACE [LESSONS]`, which draws to a page, not a terminal."""

from __future__ import annotations

import signal
import sys
from pathlib import Path

from tutor.process.prctl import die_with_parent
from tutor.tui import run


def main(workspace: str, lessons: str | None = None) -> int:
    """Run the app. If the server is killed, the app gets SIGTERM, so that it saves before it exits."""
    die_with_parent(signal.SIGTERM)
    return run(Path(workspace), None if lessons is None else Path(lessons))


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
