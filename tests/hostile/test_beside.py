"""A submission that joins every domain fails, and does not disturb the checks of others.

`python -m tests.hostile.beside` tests this more thoroughly.
"""

from __future__ import annotations

import asyncio
import subprocess
import sys
from pathlib import Path

import pytest

from tests.hostile.beside import BUSY_MACHINE, JOINS_ALL, check

CHECK_WITH_STARTS_CLOSE_BY = f"""
import asyncio
from collections import deque
from pathlib import Path
from tutor.content import load_course
from tutor.engine import run_check
from tutor.ros import domain
from tutor.workspace.submissions import find_submission

domain._queue = deque(domain.IDS)  # each start's domain is the next one after the last start's
course = load_course()
submission = find_submission(course.find("i1.1"), Path({str(JOINS_ALL)!r}), None)
report = asyncio.run(run_check([submission], course, only=frozenset({{"publishes"}})))
print(*(each.verdict.status.value for each in report.exercises[0].criteria if each.id == "publishes"))
"""


@pytest.mark.timeout(240)
async def test_a_submission_that_joins_every_domain_fails_alone() -> None:
    # All criteria would take a minute of CPU.
    hostile = asyncio.to_thread(check, "i1.1", str(JOINS_ALL), "--criterion", "publishes")
    solutions = (asyncio.to_thread(check, exercise, "--solution") for exercise in ("i1.1", "i1.3", "i2.1"))
    failed, *ended = await asyncio.gather(hostile, *solutions)
    assert (failed.exit, failed.why.partition(":")[0]) == (1, "publishes")
    assert not [one for one in ended if one.exit and BUSY_MACHINE not in one.why]


def test_a_submission_that_joins_the_domain_of_its_own_other_start_fails() -> None:
    """While we wait for the first message, the program is started again to see where it is stuck."""
    ran = subprocess.run(
        [sys.executable, "-c", CHECK_WITH_STARTS_CLOSE_BY],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        cwd=Path(__file__).parents[2],
    )
    assert (ran.stdout.strip(), ran.returncode) == ("failed", 0), ran.stderr
