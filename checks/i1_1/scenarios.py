"""I1.1: the plain start, and what the scenarios in `values` and `probes` share."""

from __future__ import annotations

import asyncio
from collections.abc import Collection
from dataclasses import replace
from typing import Any

from checks.i1_1.facts import ECHO_LIMIT_S, FILE, TOPIC, TYPE, PlainStart, numeric_parameters
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import repeat_if_doubtful
from tutor.judge.stuck import is_stuck_for_ever
from tutor.judge.trace import Sample, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting import MESSAGE_GAP_S, RESENT_S, START_S, find_stuck_frames, wait_for_message
from tutor.ros_model import Parameter

SILENT_S = (1.5, 5.0)
"""A node that has been up for this long, and has sent nothing, may be stuck: we look twice."""

SPINNING_S = 1.0
"""Within this time, a node that spins answers a parameter request."""

ANSWER_S = 2.0
"""Time limit for an answer to a parameter request from a node that is up."""


@repeat_if_doubtful
async def plain_start(bench: Bench) -> PlainStart:
    """Start without parameters: does it publish, does echo show the values, does Ctrl+C end it cleanly?"""
    looks: list[asyncio.Task[tuple[Frame, ...]]] = []
    restarted, stuck_for_ever = asyncio.Event(), asyncio.Event()
    try:
        async with bench.start(FILE, watch={TOPIC: TYPE}, expected_s=7.0) as run:  # goes first: it decides a lot alone
            bench.report_progress(0.1, f"waiting for the first message on {TOPIC}")
            looks.append(asyncio.ensure_future(_look_at_silent_node(bench, run, restarted, stuck_for_ever)))
            echo, counted_from = None, 0.0
            published = await wait_for_message(run, TOPIC, TYPE, given_up=stuck_for_ever.is_set)
            if published and restarted.is_set():
                await cancel(looks)
                counted_from = run.now()
                published = await run.until(lambda: bool(_samples_from(run, counted_from)), MESSAGE_GAP_S)
            if published:
                bench.report_progress(0.5, "watching as `ros2 topic echo` does")
                echo = await run.echo(TOPIC, samples=1, limit_s=ECHO_LIMIT_S)
            parameters = await run.parameters(ANSWER_S) if not stuck_for_ever.is_set() else None
            trace = run.trace()
            trace = replace(trace, samples={**trace.samples, TOPIC: _samples_from(trace, counted_from)})
            bench.report_progress(0.8, "pressing Ctrl+C")
            ended = await run.interrupt() if run.exit is None else None
        silent = not trace.samples_on(TOPIC) and parameters is None and trace.exit is None and bool(trace.graph.nodes)
        frames = (await looks[0] or await find_stuck_frames(bench, FILE)) if silent and not looks[0].cancelled() else ()
    finally:
        await cancel(looks)
    return PlainStart(trace, parameters, echo, ended, frames, stuck_for_ever.is_set())


def _samples_from(seen: Run | Trace, time: float) -> tuple[Sample, ...]:
    """The temperatures that were sent at or after this time, in seconds since the epoch."""
    return tuple(sample for sample in seen.samples_on(TOPIC) if sample.source_time >= time)


def _is_silent(run: Run) -> bool:
    return run.exit is None and not run.samples_on(TOPIC)


async def _look_at_silent_node(
    bench: Bench, run: Run, restarted: asyncio.Event, stuck_for_ever: asyncio.Event
) -> tuple[Frame, ...]:
    """Once the node has sent nothing and answered nothing for a while, return the stack of another start; else ().

    Meanwhile, its first message may still come. `restarted` is set before the other start: a program that joins domains
    other than its own may send a message to its first run from there, so only later ones count. `stuck_for_ever` is set
    if the stack shows that no message can come.
    """
    await run.until(lambda: bool(run.graph.nodes), START_S)
    up_at = run.now()
    for silent_s in SILENT_S:
        await run.until(lambda until=up_at + silent_s: not _is_silent(run) or run.now() >= until, silent_s)  # type: ignore[misc]
        if not _is_silent(run):
            return ()
        if await run.parameters(SPINNING_S) is None and _is_silent(run):
            restarted.set()
            frames = await find_stuck_frames(bench, FILE)
            if is_stuck_for_ever(run, frames):
                stuck_for_ever.set()
            return frames
    return ()


async def parameters(bench: Bench) -> tuple[Parameter, ...] | None:
    """Return the declared parameters, or None if the node never answers."""
    async with bench.start(FILE, watch={TOPIC: TYPE}, expected_s=5.0) as run:  # the rate probes wait for this
        bench.report_progress(0.1, "asking for its parameters")
        if not await run.until(lambda: bool(run.graph.parameter_nodes), START_S, idle_s=RESENT_S):
            return None
        declared = await run.parameters(4.0)
        if declared is not None and not numeric_parameters(declared):
            await wait_for_message(run, TOPIC, TYPE)  # the node may declare them late
            declared = await run.parameters(4.0)
        return declared


def values_of(seen: Run | Trace) -> list[float]:
    """The temperatures received in this run."""
    return [sample.message["data"] for sample in seen.samples_on(TOPIC)]


async def cancel(tasks: Collection[asyncio.Task[Any]]) -> None:
    """Cancel tasks, and wait until they have ended."""
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
