"""A submission that joins every domain fails, and does not disturb the checks of others.

`python -m tests.hostile.beside` tests this more thoroughly.
"""

from __future__ import annotations

import asyncio
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest

from tests.hostile.beside import BUSY_MACHINE, JOINS_ALL, check
from tutor.ros.domain import IDS

CHECK_WITH_STARTS_CLOSE_BY = """
import asyncio, sys
from collections import deque
from pathlib import Path
from tutor.content import load_course
from tutor.engine import run_check
from tutor.ros import domain
from tutor.workspace.submission_lookup import find_submission

domain._queue = deque(domain.IDS)  # each start's domain is the next one after the last start's
course = load_course()
submission = find_submission(course.find("i1.1"), Path(sys.argv[1]), None)
report = asyncio.run(run_check([submission], course, only=frozenset({"publishes"})))
print(*(each.verdict.status.value for each in report.exercises[0].criteria if each.id == "publishes"))
"""
JOINS_ONE_AFTER_ANOTHER = """for domain in itertools.cycle([*near, *range(233)]):
        joined.append(join(domain))"""
STAYS_IN_ALL = """joined = [join(domain) for domain in near]
    for domain in itertools.cycle(near):"""
"""What the hostile submission does, and a variant."""

LIED_ABOUT = {
    "i1.1": ("publishes", "range", "rate"),
    "i1.3": ("services", "operations"),
    "i2.1": ("defaults",),
}
"""The criteria that would notice what the hostile submission publishes, answers and declares."""


@pytest.mark.timeout(240)
async def test_a_submission_that_joins_every_domain_fails_alone() -> None:
    # All criteria would take a minute of CPU.
    hostile = asyncio.to_thread(check, "i1.1", str(JOINS_ALL), "--criterion", "publishes")
    solutions = (
        asyncio.to_thread(check, exercise, "--solution", *(f"--criterion={each}" for each in LIED_ABOUT[exercise]))
        for exercise in LIED_ABOUT
    )
    failed, *ended = await asyncio.gather(hostile, *solutions)
    assert (failed.exit, failed.why.partition(":")[0]) == (1, "publishes")
    assert not [one for one in ended if one.exit and BUSY_MACHINE not in one.why]


def test_a_submission_that_joins_the_domain_of_its_own_other_start_fails(tmp_path: Path) -> None:
    """While we wait for the first message, the program is started again to see where it is stuck."""
    (source,) = JOINS_ALL.glob("*.py")
    text = source.read_text()
    # It stays in the domains next to its own, one of which is the other start's.
    gaps = {after - before for before, after in pairwise(IDS)}
    for old, new in (
        ("range(-40, 41)", str([*gaps, *(-gap for gap in gaps)])),
        (JOINS_ONE_AFTER_ANOTHER, STAYS_IN_ALL),
    ):
        assert text.count(old) == 1
        text = text.replace(old, new)
    (tmp_path / source.name).write_text(text)
    ran = subprocess.run(
        [sys.executable, "-c", CHECK_WITH_STARTS_CLOSE_BY, tmp_path],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        cwd=Path(__file__).parents[2],
    )
    assert (ran.stdout.strip(), ran.returncode) == ("failed", 0), ran.stderr
