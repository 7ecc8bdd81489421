"""A submission that joins every domain: how it is judged, and beside it the checks of others.

`python -m tests.hostile.beside` asks more of it.
"""

from __future__ import annotations

import asyncio

import pytest

from tests.hostile.beside import BUSY, JOINS_ALL, check


@pytest.mark.timeout(240)
async def test_anyone_who_joins_every_domain_is_failed_and_fails_nobody_else() -> None:
    hostile = asyncio.to_thread(check, "i1.1", str(JOINS_ALL), "--criterion", "publishes")  # all takes a minute of CPU
    solutions = (asyncio.to_thread(check, exercise, "--solution") for exercise in ("i1.1", "i1.3", "i2.1"))
    failed, *ended = await asyncio.gather(hostile, *solutions)
    assert (failed.exit, failed.why.partition(":")[0]) == (1, "publishes")
    assert not [one for one in ended if one.exit and BUSY not in one.why]
