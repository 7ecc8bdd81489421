"""I1.1: the plain start, and what the scenarios in `values` and `probes` share."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Collection
from dataclasses import replace
from typing import Any

from checks.i1_1.facts import ECHO_LIMIT_S, FILE, MATCHED_S, TOPIC, TYPE, PlainStart, go_on, numeric_parameters
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import repeat_if_doubtful
from tutor.judge.stuck import is_stuck_for_ever
from tutor.judge.trace import Sample, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting import IDLE_S, MESSAGE_GAP_S, RESENT_S, START_S, find_stuck_frames, wait_for_message
from tutor.ros_model import Parameter

SILENT_S = (1.5, 5.0)
"""A node that has sent nothing for this long may be stuck: we look twice."""

SPINNING_S = 1.0
"""Within this time, a node that spins answers a parameter request."""

ANSWER_S = 2.0
"""Time limit for an answer to a parameter request from a node that is up."""


@repeat_if_doubtful
async def plain_start(bench: Bench) -> PlainStart:
    """Start without parameters: do messages go on arriving, does echo show them, does Ctrl+C end it cleanly?"""
    tasks: list[asyncio.Future[Any]] = []
    stuck = _StuckNode(bench)
    try:
        async with bench.start(FILE, watch={TOPIC: TYPE}, expected_s=7.0) as run:  # goes first: it decides a lot alone
            bench.report_progress(0.1, f"waiting for the first message on {TOPIC}")
            began, looking = asyncio.ensure_future(_first_sign_at(run)), asyncio.ensure_future(stuck.look(run))
            tasks += (began, looking)
            echo, declared, counted_from = None, None, math.inf
            if await wait_for_message(run, TOPIC, TYPE, given_up=stuck.is_for_ever):
                bench.report_progress(0.5, "watching as `ros2 topic echo` does")
                echoing = asyncio.ensure_future(run.echo(TOPIC, samples=1, limit_s=ECHO_LIMIT_S))
                asking = asyncio.ensure_future(run.parameters(ANSWER_S))
                tasks += (echoing, asking)
                counted_from = await _wait_until_messages_go_on(run, await began, stuck)
                if go_on(run.samples_on(TOPIC), counted_from):
                    echo = await echoing
                elif not stuck.is_for_ever():
                    declared = await asking
            elif not stuck.is_for_ever():
                declared = await run.parameters(ANSWER_S)
            trace = run.trace()
            trace = replace(trace, samples={**trace.samples, TOPIC: _samples_from(trace, stuck.restarted_at)})
            bench.report_progress(0.8, "pressing Ctrl+C")
            ended = await run.interrupt()
        facts = PlainStart(trace, declared, echo, ended, (), stuck.is_for_ever(), counted_from)
        if facts.messages_go_on or declared is not None or trace.exit is not None or not trace.graph.nodes:
            return facts
        return replace(facts, stuck=await looking or await find_stuck_frames(bench, FILE))
    finally:
        await cancel(tasks)


async def _first_sign_at(run: Run) -> float:
    """Return when a publisher on the topic, or a message, is first seen."""

    def is_there() -> bool:
        return bool(run.samples_on(TOPIC)) or any(each.topic == TOPIC for each in run.graph.publishers)

    await run.until(is_there, math.inf)
    return run.now()


async def _wait_until_messages_go_on(run: Run, began: float, stuck: _StuckNode) -> float:
    """Wait until messages go on arriving, or no more come. Return from when on they count."""

    def counted_from() -> float:
        return max(began + MATCHED_S, stuck.restarted_at)

    def is_decided() -> bool:
        return go_on(run.samples_on(TOPIC), counted_from()) or stuck.is_for_ever()

    received = -1
    while not is_decided() and len(run.samples_on(TOPIC)) != received:
        received = len(run.samples_on(TOPIC))
        await run.until(
            lambda received=received: is_decided() or len(run.samples_on(TOPIC)) != received,  # type: ignore[misc]
            MESSAGE_GAP_S,
            idle_s=IDLE_S,
        )
    return counted_from()


def _samples_from(trace: Trace, time: float) -> tuple[Sample, ...]:
    """The temperatures that were sent at or after this time, in seconds since the epoch."""
    return tuple(sample for sample in trace.samples_on(TOPIC) if sample.source_time >= time)


class _StuckNode:
    """Whether a node that sends and answers nothing is stuck, by the stack of another start.

    `restarted_at`: when that start was made, in seconds since the epoch, or 0. A program that joins domains other than
    its own may send a message to its first run from there, so only later ones count.
    """

    def __init__(self, bench: Bench) -> None:
        self._bench = bench
        self._for_ever = False
        self.restarted_at = 0.0

    def is_for_ever(self) -> bool:
        """Whether a stack has shown by now that no message can come."""
        return self._for_ever

    async def look(self, run: Run) -> tuple[Frame, ...]:
        """Once the node has sent nothing and answered nothing for a while, return the stack of another start; else ().

        Meanwhile, its next message may still come.
        """
        await run.until(lambda: bool(run.graph.nodes), START_S)
        up_at = run.now()

        def is_silent(for_s: float) -> bool:
            samples = run.samples_on(TOPIC)
            return run.now() >= (samples[-1].received_at if samples else up_at) + for_s

        for silent_s in SILENT_S:
            await run.until(lambda for_s=silent_s: is_silent(for_s), math.inf)  # type: ignore[misc]
            if run.exit is None and await run.parameters(SPINNING_S) is None and is_silent(silent_s):
                self.restarted_at = run.now()
                frames = await find_stuck_frames(self._bench, FILE)
                self._for_ever = is_stuck_for_ever(run, frames)
                return frames
        return ()


async def parameters(bench: Bench) -> tuple[Parameter, ...] | None:
    """Return the declared parameters, or None if the node never answers."""
    async with bench.start(FILE, watch={TOPIC: TYPE}, expected_s=5.0) as run:  # the rate probes wait for this
        bench.report_progress(0.1, "asking for its parameters")
        if not await run.until(lambda: bool(run.graph.nodes), START_S, idle_s=RESENT_S):
            return None
        # The services come with the node, unless it has been made without them.
        if not await run.until(lambda: bool(run.graph.parameter_nodes), RESENT_S, idle_s=RESENT_S):
            return None
        declared = await run.parameters(4.0)
        if declared is not None and not numeric_parameters(declared):
            await wait_for_message(run, TOPIC, TYPE)  # the node may declare them late
            declared = await run.parameters(4.0)
        return declared


def values_of(seen: Run | Trace) -> list[float]:
    """The temperatures received in this run."""
    return [sample.message["data"] for sample in seen.samples_on(TOPIC)]


async def cancel(tasks: Collection[asyncio.Future[Any]]) -> None:
    """Cancel tasks, and wait until they have ended."""
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
