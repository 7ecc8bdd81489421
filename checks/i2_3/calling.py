"""I2.3: what every call needs: the service, a node that spins, a time limit, and operands."""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import dataclass

from checks.i2_3.facts import (
    ANSWER_TIMEOUT_S,
    CALLS,
    EXCUSED_S,
    FILE,
    LONGEST_S,
    SERVICE,
    TYPE,
    has_service,
)
from tutor.judge.bench import Bench, Run
from tutor.judge.stuck import ask_unless_stuck
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting import find_stuck_frames, patience_s, wait_until_seen

DISCOVERY_S = 1.0
"""Time limit for all services of a node to appear in the graph once the node is discovered."""

STUCK_CALL_S = 1.0
"""Timeout of a call to a node that waits for ever."""

SPIN_S = 2.5
"""A node spins within twice this time of its service being discovered, or never."""


async def wait_for_service(run: Run) -> bool:
    """Wait for the service, and return whether it exists."""
    return await wait_until_seen(
        run,
        lambda: has_service(run.graph.servers),
        settle_s=lambda: patience_s(((each.name, each.type) for each in run.graph.servers), SERVICE, TYPE),
    )


async def dump_silent_node(bench: Bench) -> tuple[Frame, ...]:
    """Start the node again, only to return its stack while nobody asks it for anything."""
    return await find_stuck_frames(bench, FILE)


@dataclass(frozen=True)
class Readiness:
    """Whether a node spins, whether it waits for ever instead, and the timeout of a call to it, in seconds."""

    spins: bool = True
    is_stuck: bool = False
    limit_s: float = ANSWER_TIMEOUT_S


async def wait_until_spinning(bench: Bench, run: Run) -> Readiness:
    """Wait until the node answers a parameter request; one without parameter services is taken to spin.

    A node may be in the graph long before it spins, so that a call has time to wait for that, and for the work.
    """
    if not await run.until(lambda: bool(run.graph.parameter_nodes), DISCOVERY_S):
        return Readiness()
    answer, is_stuck = await ask_unless_stuck(run, SPIN_S, lambda: bench.facts(dump_silent_node))
    if answer is not None:
        return Readiness()
    return Readiness(False, is_stuck, STUCK_CALL_S if is_stuck else SPIN_S + LONGEST_S + EXCUSED_S)


def total_cpu_wait_s(run: Run) -> float:
    """How long the node and our own process have waited for a CPU, in seconds."""
    return run.node_cpu_wait_s() + run.our_cpu_wait_s()


def random_operands() -> Mapping[str, int]:
    """Random operands, so that the sum cannot be known in advance."""
    return {"a": random.randint(-900, 900), "b": random.randint(1000, 9000)}


def large_operands() -> Mapping[str, int]:
    """Operands whose sum needs a 64-bit integer: neither 32 bits nor a float can represent it.

    Their product fits into one, too, so that a node that multiplies answers all the same.
    """
    return {"a": 2**53 + 2 * random.randint(1, 2**50) + 1, "b": 2 * random.randint(1, 400)}


def distinct_operands() -> list[Mapping[str, int]]:
    """Operands for concurrent calls, whose sums all differ."""
    start = random.randint(-900, 900)
    return [{"a": start + 1000 * number, "b": random.randint(1, 900)} for number in range(CALLS)]
