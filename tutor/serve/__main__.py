"""The app behind one page: `python -m tutor.serve WORKSPACE [LESSONS]`, with a page where a terminal would be."""

from __future__ import annotations

import signal
import sys
from pathlib import Path

from tutor.process.prctl import die_with_parent
from tutor.tui import run


def main(workspace: str, lessons: str | None = None) -> int:
    """Open the app. It is asked to leave when the server is killed, and saves first."""
    die_with_parent(signal.SIGTERM)
    return run(Path(workspace), None if lessons is None else Path(lessons))


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
