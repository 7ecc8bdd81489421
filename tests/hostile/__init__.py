"""Submissions that try to fool the tool, to blame others or to break it, and what checking them costs.

    hostile/submissions/<exercise>/<name>/    the learner's files and an expect.yaml (see tests/submissions/README.md)

`python -m tests.hostile` checks them all from the command line and prints a table.
"""

from __future__ import annotations

from pathlib import Path

from tutor.content.submissions import EXPECT, Case, read_expected

ROOT = Path(__file__).parent / "submissions"


def find_hostile() -> list[Case]:
    """Return all hostile cases, sorted by name. Raises ContentError if an expect.yaml is broken."""
    return [
        Case(file.parts[-3].replace("_", "."), "hostile", file.parent, read_expected(file))
        for file in sorted(ROOT.glob(f"*/*/{EXPECT}"))
    ]
