"""Process starts take turns: a few at a time, the longest first, and none waits forever."""

from __future__ import annotations

import asyncio

import pytest

from tutor.engine.scheduling import GATHER_ITERATIONS, StartLimiter


class Starts:
    """Fake processes that start when they get a slot, and are up or over when the test says so."""

    def __init__(self, slots: int) -> None:
        self.start_limiter = StartLimiter(slots)
        self.began: list[str] = []
        self.up: dict[str, asyncio.Event] = {}
        self.over: dict[str, asyncio.Event] = {}

    def begin(self, name: str, expected_s: float) -> asyncio.Task[None]:
        self.up[name], self.over[name] = asyncio.Event(), asyncio.Event()

        async def start() -> None:
            async with self.start_limiter.slot(expected_s) as up:
                self.began.append(name)
                await self.up[name].wait()
                up()
                await self.over[name].wait()

        return asyncio.ensure_future(start())


async def settle() -> None:
    for _ in range(5 + GATHER_ITERATIONS):
        await asyncio.sleep(0)


async def test_the_longest_starts_first_and_a_slot_is_freed_when_a_process_is_up() -> None:
    starts = Starts(2)
    tasks = [starts.begin(name, expected_s) for name, expected_s in (("a", 1), ("b", 1), ("c", 2), ("d", 5), ("e", 2))]
    await settle()
    assert starts.began == ["d", "c"]  # of two equally long ones, the first to ask
    tasks.append(starts.begin("f", 9))
    await settle()
    assert starts.began == ["d", "c"]
    starts.up["d"].set()
    await settle()
    assert starts.began == ["d", "c", "f"]
    starts.up["c"].set()
    starts.up["f"].set()
    await settle()
    assert starts.began == ["d", "c", "f", "e", "a"]
    for name in "abcdef":
        starts.up[name].set()
        starts.over[name].set()
    await asyncio.gather(*tasks)


async def test_starts_requested_a_moment_later_are_considered() -> None:
    """As when a scenario starts several processes, each in its own task."""
    starts = Starts(1)

    async def begin(name: str, expected_s: float) -> None:
        await asyncio.sleep(0)
        await starts.begin(name, expected_s)

    tasks = [starts.begin("a", 1), asyncio.ensure_future(begin("b", 2))]
    await settle()
    assert starts.began == ["b"]
    for name in "ba":
        starts.up[name].set()
        starts.over[name].set()
    await asyncio.gather(*tasks)


async def test_a_process_that_ends_before_it_is_up_frees_its_slot_once() -> None:
    starts = Starts(1)
    first, second, third = (starts.begin(name, 1) for name in "abc")
    await settle()
    first.cancel()
    await settle()
    assert starts.began == ["a", "b"]
    starts.up["b"].set()
    starts.over["b"].set()
    await second
    await settle()
    assert starts.began == ["a", "b", "c"]
    fourth = starts.begin("d", 1)
    await settle()
    assert starts.began == ["a", "b", "c"]  # b was up, then over: one slot, not two
    for task in (third, fourth):
        task.cancel()


@pytest.mark.parametrize("has_slot", [False, True])
async def test_a_cancelled_wait_keeps_no_slot(has_slot: bool) -> None:
    starts = Starts(1)
    async with starts.start_limiter.slot(1) as up:
        gives_up = starts.begin("a", 1)
        await settle()
        if has_slot:  # it gets the slot, but is cancelled before it can use it
            up()
        gives_up.cancel()
        await settle()
    next_one = starts.begin("b", 1)
    await settle()
    assert starts.began == ["b"]
    next_one.cancel()


async def test_there_is_one_slot_more_than_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("os.sched_getaffinity", lambda pid: {0, 1, 4})
    starts = Starts(0)
    tasks = [starts.begin(str(number), 1) for number in range(9)]
    await settle()
    assert len(starts.began) == 4
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
