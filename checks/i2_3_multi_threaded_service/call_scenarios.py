"""I2.3: how to call the service, and the scenarios that call three times at once, and press Ctrl+C during a call."""

from __future__ import annotations

import asyncio
import random
from collections.abc import Mapping
from dataclasses import dataclass

from checks.i2_3_multi_threaded_service.calls import (
    ALLOWANCE_S,
    CALLS,
    LONGEST_S,
    PROGRAM,
    SERVER,
    SLOW_ADD,
    Call,
    CallBatch,
    needs_repeat_at_once,
)
from tutor.exercise.node_parameters import DumpSilentNode
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import repeat_chance_failures
from tutor.judge.stuck_nodes import ask_unless_stuck
from tutor.judge.tasks import Tasks
from tutor.judge.trace import CallAnswer, Ending, Trace

ANSWER_TIMEOUT_S = 8.0
"""Timeout of a call: a service that answers later than 3 s, but within this time, is reported as too slow.

A request that is lost at first is resent within 3.5 s, so a correct answer may take 7 s.
"""

DISCOVERY_S = 1.0
"""Time limit for all services of a node to appear in the graph once the node is discovered."""

STUCK_CALL_S = 1.0
"""Timeout of a call to a node that waits for ever."""

SPIN_S = 2.5
"""A node spins within twice this time of its service being discovered, or never."""

APART_S = 0.1
"""Delay of the last of three concurrent calls, so that the order of the answers has a meaning."""

INTO_CALL_S = 1.5
"""A call is being processed this long after the request."""

dump_silent_node = DumpSilentNode(PROGRAM)


@dataclass(frozen=True)
class Readiness:
    """What is known of a node before it is called: that it spins, or that it waits for ever instead."""

    spins: bool = True
    is_stuck: bool = False

    @property
    def limit_s(self) -> float:
        """The timeout of a call to it: it may be in the graph long before it spins, and needs time for the work."""
        if self.is_stuck:
            return STUCK_CALL_S
        return ANSWER_TIMEOUT_S if self.spins else SPIN_S + LONGEST_S + ALLOWANCE_S


async def wait_for_service(run: Run) -> bool:
    """Wait for the service, and return whether it exists."""
    await SERVER.wait(run)
    return not SERVER.missing(run.graph.servers)


async def wait_until_spinning(bench: Bench, run: Run) -> Readiness:
    """Wait until the node answers a parameter request; one without parameter services is taken to spin."""
    if not await run.until(lambda: bool(run.graph.parameter_nodes), DISCOVERY_S):
        return Readiness()
    answer, is_stuck = await ask_unless_stuck(run, SPIN_S, lambda: bench.facts(dump_silent_node))
    return Readiness(answer is not None, is_stuck)


def total_cpu_wait_s(run: Run) -> float:
    """How long the node and our own process have waited for a CPU, in seconds."""
    return run.node_cpu_wait_s() + run.our_cpu_wait_s()


async def make_call(run: Run, limit_s: float = ANSWER_TIMEOUT_S, request: Mapping[str, int] | None = None) -> Call:
    """Call the service, with random operands if none are given."""
    waited_s, (operands,) = total_cpu_wait_s(run), random_operands(1)
    answer = await run.call(SLOW_ADD.name, SLOW_ADD.type, request or operands, limit_s=limit_s)
    return Call(answer, run.now(), total_cpu_wait_s(run) - waited_s)


def random_operands(calls: int) -> list[Mapping[str, int]]:
    """Random operands of some calls, so that no sum can be known in advance; the sums all differ."""
    return [
        {"a": random.randint(-900, 900), "b": 4000 * number + random.randint(1000, 1900)} for number in range(calls)
    ]


def large_operands() -> Mapping[str, int]:
    """Operands whose sum needs a 64-bit integer: neither 32 bits nor a float can represent it.

    Their product fits into one, too, so that a node that multiplies answers all the same.
    """
    return {"a": 2**53 + 2 * random.randint(1, 2**50) + 1, "b": 2 * random.randint(1, 400)}


@dataclass(frozen=True)
class ConcurrentCalls:
    """Batches of three concurrent calls: several if the machine may have delayed them, none if there was no service."""

    trace: Trace
    batches: tuple[CallBatch, ...] = ()


async def call_concurrently(bench: Bench) -> ConcurrentCalls:
    """Make three concurrent calls, each with its own sum."""
    async with bench.start(PROGRAM.file, expected_s=3.5) as run:
        bench.report_progress(0.1, f"waiting for {SLOW_ADD.name}")
        if not await wait_for_service(run):
            return ConcurrentCalls(run.trace())
        ready = await wait_until_spinning(bench, run)
        bench.report_progress(0.3, f"calling {SLOW_ADD.name} three times at once")
        batches = [await _call_at_once(run, ready.limit_s)]
        while needs_repeat_at_once(tuple(batches)):
            batches.append(await _call_at_once(run, ready.limit_s))
        return ConcurrentCalls(run.trace(), tuple(batches))


async def _call_at_once(run: Run, limit_s: float) -> CallBatch:
    """Make all calls at once; give up if no answer has come for `limit_s`, the timeout of a single call."""
    asked_at, waited_s, requests = run.now(), total_cpu_wait_s(run), random_operands(CALLS)
    calls: list[asyncio.Task[CallAnswer]] = []
    async with Tasks() as tasks:
        for request in requests:
            if len(calls) == CALLS - 1:
                await run.until(lambda: run.now() >= asked_at + APART_S, 1.0)
            calls.append(tasks.start(run.call(SLOW_ADD.name, SLOW_ADD.type, request, limit_s=CALLS * limit_s)))
        while (done := tasks.count_done()) < CALLS:
            if not await run.until(lambda done=done: tasks.count_done() > done, limit_s):  # type: ignore[misc]
                break
    answers = tuple(
        CallAnswer(SLOW_ADD.name, request, None, asked_at, run.now()) if call.cancelled() else call.result()
        for request, call in zip(requests, calls, strict=True)
    )
    return CallBatch(answers, total_cpu_wait_s(run) - waited_s)


@dataclass(frozen=True)
class Interrupted:
    """A run with Ctrl+C during a call. `called`: whether there was a service to call.

    `slowed`: the node ended during the call, but not before Ctrl+C was due: the machine is to blame for that.
    """

    trace: Trace
    called: bool
    ending: Ending | None = None
    slowed: bool = False


@repeat_chance_failures
async def interrupt_during_call(bench: Bench) -> Interrupted:
    """Press Ctrl+C during a call."""
    async with bench.start(PROGRAM.file, expected_s=2.0) as run, Tasks() as tasks:
        bench.report_progress(0.1, f"waiting for {SLOW_ADD.name}")
        called = await wait_for_service(run)
        if called:
            await wait_until_spinning(bench, run)
        due, waited_s = run.now() + INTO_CALL_S, run.node_cpu_wait_s()
        if called:
            bench.report_progress(0.4, f"calling {SLOW_ADD.name}")
            call = tasks.start(make_call(run))
            await run.until(lambda: call.done() or run.now() >= due + run.node_cpu_wait_s() - waited_s, 2 * INTO_CALL_S)
        trace = run.trace()
        bench.report_progress(0.7, "pressing Ctrl+C during the call")
        ending = await run.interrupt()
        slowed = ending is None and run.exit is not None and run.started_at + run.exit.after_s >= due
        return Interrupted(trace, called, ending, slowed)
