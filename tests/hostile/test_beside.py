"""A submission that joins every domain: how it is judged, and beside it the checks of others.

`python -m tests.hostile.beside` asks more of it.
"""

from __future__ import annotations

import asyncio

import pytest

from tests.hostile import find_hostile
from tests.hostile.beside import BUSY, JOINS_ALL, check
from tests.judging import judge


@pytest.mark.timeout(240)
async def test_anyone_who_joins_every_domain_is_failed_and_fails_nobody_else() -> None:
    (joins_all,) = (case for case in find_hostile() if case.folder == JOINS_ALL)
    solutions = (asyncio.to_thread(check, exercise, "--solution") for exercise in ("i1.1", "i1.3", "i2.1"))
    outcome, ended = await asyncio.gather(judge(joins_all), asyncio.gather(*solutions))
    assert outcome.wrong == []
    assert not [one for one in ended if one.exit and BUSY not in one.why]
