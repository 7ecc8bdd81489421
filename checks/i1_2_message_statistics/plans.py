"""I1.2: what is sent to the node in each trial."""

from __future__ import annotations

import random
from collections.abc import Awaitable, Callable
from dataclasses import dataclass

from tutor.judge.bench import Bench

STEADY_HZ = (4.9, 5.0)
"""Bounds of the steady talker's constant, random rate.

Slow enough that a rate over the last second is right once ten messages have come. No common mistake gives this rate:
neither a count (10, 20), nor a count divided by the whole seconds of the time that it took (1 of 1.8 s, 3 of 3.8 s).
"""
STEADY_MESSAGES = 20

UNTIMED_HZ = 8.0
"""The rate of messages in trials that do not judge rates."""
JUMP_AFTER, SECOND_JUMP_AFTER, JUMP_MESSAGES = 17, 27, 33
"""N jumps far; on another start, it also leaves out one number later.

A summary before the first jump shows what is usual at this rate: without it, a rate of 8.00 passed for a report, as it
had been 5.00 in another run. One is due soon after each jump, and after a single jump, one covers ten consecutive
messages. A node that restarts its count at the first jump reaches ten again before the end.
"""

AFTER_ZERO_MESSAGES = 12
"""On one more start, N jumps from 0; the next summary is due soon afterwards."""

FIRST_NUMBERS = (90, 97)
"""Range of the first N. It passes 100 before the jump, where nodes that compare texts or two last digits go wrong."""
LEFT_OUT = (4, 8)
"""Range of how many numbers the first jump leaves out.

With these, what N is ahead of the number expected at the jump is no count of messages, from 0 or from 1, at any time.
"""

FAST_HZ, FAST_MESSAGES = 25.0, 60
"""A stretch at a rate that is common on robots: a node that handles only ten messages per second loses a third."""

RESTART_AFTER, RESTART_MESSAGES = 13, 25
RESTARTED_HZ = 9.4
"""The rate of the second publisher: no rate over any of the messages since then is still UNTIMED_HZ."""


@dataclass(frozen=True)
class Chosen:
    """What is chosen for all trials of a check, so that those in which N jumps can be compared.

    `first`: the first N. `left_out`: how many numbers the first jump leaves out.
    """

    first: int
    left_out: int


async def choose(bench: Bench) -> Chosen:
    """Choose once for all trials: the facts of a scenario are gathered once."""
    return Chosen(random.randint(*FIRST_NUMBERS), random.randint(*LEFT_OUT))


@dataclass(frozen=True)
class Stretch:
    """Messages with these N, at a steady rate. `another_publisher`: a new one sends them; the last one goes away."""

    numbers: range
    hz: float = UNTIMED_HZ
    another_publisher: bool = False


Plan = Callable[[Bench], Awaitable[tuple[Stretch, ...]]]
"""The stretches that are sent one after the other; N rises by one within each, but not from one to the next."""


async def steadily(bench: Bench) -> tuple[Stretch, ...]:
    """N rises by one from 0, at a rate that no mistake gives."""
    return (Stretch(range(STEADY_MESSAGES), random.uniform(*STEADY_HZ)),)


async def fast(bench: Bench) -> tuple[Stretch, ...]:
    """Messages come as fast as from a typical sensor for a short while."""
    first = random.randint(0, 50)
    return (Stretch(range(first, first + FAST_MESSAGES), FAST_HZ),)


async def jumping(bench: Bench) -> tuple[Stretch, ...]:
    """N starts high, and jumps over several numbers."""
    chosen = await bench.facts(choose)
    after = chosen.first + JUMP_AFTER + chosen.left_out
    return (
        Stretch(range(chosen.first, chosen.first + JUMP_AFTER)),
        Stretch(range(after, after + JUMP_MESSAGES - JUMP_AFTER)),
    )


async def jumping_twice(bench: Bench) -> tuple[Stretch, ...]:
    """The same, and ten messages later one more number is left out."""
    before, after = await jumping(bench)
    again = after.numbers[SECOND_JUMP_AFTER - JUMP_AFTER :]
    between = after.numbers[: SECOND_JUMP_AFTER - JUMP_AFTER]
    return before, Stretch(between), Stretch(range(again.start + 1, again.stop + 1))


async def jumping_after_zero(bench: Bench) -> tuple[Stretch, ...]:
    """N is 0 in the first message, and jumps over several numbers right after it."""
    after = (await bench.facts(choose)).left_out + 1
    return Stretch(range(1)), Stretch(range(after, after + AFTER_ZERO_MESSAGES - 1))


async def starting_over(bench: Bench) -> tuple[Stretch, ...]:
    """The publisher goes away, and another one starts over at 0, at another rate.

    The first N is low enough that the second publisher repeats numbers of the first: a node that takes those for
    duplicates fails.
    """
    first = random.randint(3, 6)
    return (
        Stretch(range(first, first + RESTART_AFTER)),
        Stretch(range(RESTART_MESSAGES - RESTART_AFTER), RESTARTED_HZ, another_publisher=True),
    )
