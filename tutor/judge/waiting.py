"""Waits that several checks share: for a node to come up, and for enough messages to tell a rate."""

from __future__ import annotations

from collections.abc import Callable

from tutor.judge.bench import Run
from tutor.judge.rates import Rate, measure

START_S = 15.0
"""A process on a slow, busy machine may need this long to come up."""

SETTLE_S = 5.0
"""A node that is up does what it does within this time, a pause of 2 s at its start included."""

RARE_S = 12.0
"""A publisher that exists may wait this long between messages."""


async def appears(run: Run, seen: Callable[[], bool], *, promised: Callable[[], bool] = lambda: False) -> bool:
    """Wait until `seen()`; give up when the process ends, never makes a node, or its node does nothing of the kind.

    `promised()`: something announces that it will come, such as a publisher on the topic; then the wait is longer.
    """
    if await run.until(lambda: seen() or bool(run.graph.nodes), START_S) and not seen():
        await run.until(lambda: seen() or promised(), SETTLE_S)
        if promised() and not seen():
            await run.until(seen, RARE_S)
    return seen()


async def first_message(run: Run, topic: str, type_name: str) -> bool:
    """Wait for a message of this type on this (watched) topic."""
    return await appears(
        run,
        lambda: bool(run.on(topic)),
        promised=lambda: any(p.topic == topic and p.type == type_name for p in run.graph.publishers),
    )


def window_s(hz: float) -> float:
    """How many seconds of messages it takes to tell this rate: two periods at least, and one second."""
    return max(1.0, (2.0 if hz < 1 else 3.0) / hz)


async def steady_rate(run: Run, topic: str, asked_hz: float, *, since: float) -> tuple[Rate | None, int]:
    """The rate on `topic` from source time `since` on, and the number of messages it is taken from.

    Listens for as long as `asked_hz` needs; where what it hears does not agree, for as long again, and judges by that second
    stretch alone: a hiccup at the start of it is the machine's, a rate that stays wrong is the learner's.
    """
    window = window_s(asked_hz)
    start = max(since, run.now())
    for _ in range(2):
        end = start + window + 0.5 / asked_hz
        await run.until(lambda end=end: run.now() >= end + 0.1, window * 2 + 2)  # type: ignore[misc]
        heard = [sample for sample in run.on(topic) if start <= sample.source_time <= end]
        rate = measure(heard)
        if rate is not None and rate.agrees(asked_hz):
            break
        start = end
    return rate, len(heard)
