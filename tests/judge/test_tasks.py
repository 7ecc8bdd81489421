"""Tasks end with the block that started them."""

from __future__ import annotations

import asyncio

from tutor.judge.tasks import Tasks


async def answer() -> int:
    return 42


def test_what_is_still_under_way_is_cancelled_and_waited_for() -> None:
    async def leave_a_task_behind() -> tuple[int, int, bool]:
        async with Tasks() as tasks:
            endless = tasks.start(asyncio.Event().wait())
            answered = await tasks.start(answer())
            done = tasks.count_done()
        return answered, done, endless.cancelled()

    assert asyncio.run(leave_a_task_behind()) == (42, 1, True)
