"""Starts take turns: a few at a time, the longest first, and nobody waits forever."""

from __future__ import annotations

import asyncio

import pytest

from tutor.engine.start_limiter import ITERATIONS, StartLimiter


class Starts:
    """Processes that start when they are let in, and are up when told."""

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
    for _ in range(5 + ITERATIONS):
        await asyncio.sleep(0)


async def test_the_longest_goes_first_and_a_slot_is_free_when_a_process_is_up() -> None:
    starts = Starts(2)
    tasks = [starts.begin(name, asks) for name, asks in (("a", 1), ("b", 1), ("c", 2), ("d", 5), ("e", 2))]
    await settle()
    assert starts.began == ["d", "c"]  # of two that are as long, the one that came first
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


async def test_those_that_are_begun_a_moment_later_take_part() -> None:
    """As where a scenario begins several starts, each in a task of its own."""
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


async def test_an_end_before_it_is_up_frees_the_slot_once() -> None:
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


@pytest.mark.parametrize("given_it", [False, True])
async def test_anyone_who_gives_up_waiting_takes_no_slot_along(given_it: bool) -> None:
    starts = Starts(1)
    async with starts.start_limiter.slot(1) as up:
        gives_up = starts.begin("a", 1)
        await settle()
        if given_it:  # and cancelled before it could do anything with it
            up()
        gives_up.cancel()
        await settle()
    next_one = starts.begin("b", 1)
    await settle()
    assert starts.began == ["b"]
    next_one.cancel()


async def test_it_has_a_slot_for_each_core_and_one_more(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("os.sched_getaffinity", lambda pid: {0, 1, 4})
    starts = Starts(0)
    tasks = [starts.begin(str(number), 1) for number in range(9)]
    await settle()
    assert len(starts.began) == 4
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
