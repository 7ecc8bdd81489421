"""A submission that joins every domain fails, and does not disturb the checks of others.

`python -m tests.hostile.beside` tests this more thoroughly.
"""

from __future__ import annotations

import asyncio

import pytest

from tests.hostile.beside import BUSY_MACHINE, JOINS_ALL, check


@pytest.mark.timeout(240)
async def test_a_submission_that_joins_every_domain_fails_alone() -> None:
    # All criteria would take a minute of CPU.
    hostile = asyncio.to_thread(check, "i1.1", str(JOINS_ALL), "--criterion", "publishes")
    solutions = (asyncio.to_thread(check, exercise, "--solution") for exercise in ("i1.1", "i1.3", "i2.1"))
    failed, *ended = await asyncio.gather(hostile, *solutions)
    assert (failed.exit, failed.why.partition(":")[0]) == (1, "publishes")
    assert not [one for one in ended if one.exit and BUSY_MACHINE not in one.why]
