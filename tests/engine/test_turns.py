"""Checks of one machine take turns."""

from __future__ import annotations

import os
import subprocess
import sys

from tests.ros.own_network import OWN_NETWORK, needs_own_network

# With nobody else's checks beside them: ten, of which each notes how many are under way.
TEN = """
import asyncio, os
from tutor.engine.turns import turn

async def main():
    under_way, most = 0, 0
    async def check():
        nonlocal under_way, most
        async with turn():
            under_way += 1
            most = max(most, under_way)
            await asyncio.sleep(0.05)
            under_way -= 1
    await asyncio.gather(*(check() for _ in range(10)))
    assert most == min(10, 2 * len(os.sched_getaffinity(0))), most
    async with asyncio.timeout(20):
        async with asyncio.TaskGroup() as group:
            for _ in range(10):
                group.create_task(late())

async def late():
    async with turn(limit_s=0.3):
        await asyncio.sleep(1)  # longer than the others wait

asyncio.run(main())
"""


@needs_own_network
def test_two_at_once_for_each_core_but_nobody_waits_for_ever() -> None:
    subprocess.run(
        [sys.executable, "-c", OWN_NETWORK + TEN], check=True, timeout=60, env={**os.environ, "PYTHONPATH": os.getcwd()}
    )
