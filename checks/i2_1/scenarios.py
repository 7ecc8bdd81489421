"""I2.1: the scenarios that start the node and gather the facts of its start."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import Any

from checks.i2_1.access import dump_if_stuck, find_node, has_publisher, read_parameters
from checks.i2_1.facts import (
    ANSWER_S,
    BAD_RATES,
    DEFAULT_HZ,
    ENABLED,
    FILE,
    LAUNCH_HZ,
    MESSAGE_GAP_S,
    PREFIX,
    RATE,
    SLOW_LAUNCH_HZ,
    TOPIC,
    TYPE,
    DisabledStart,
    ParameterStarts,
    PlainStart,
    RatedStart,
    find_parameter,
    find_without_prefix,
    messages_naming_rate,
)
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import repeat_if_doubtful
from tutor.judge.rates import Rate, measure
from tutor.judge.trace import Trace
from tutor.judge.waiting import IDLE_S, measure_steady_rate, wait_for_message, wait_until_seen, window_s


@repeat_if_doubtful
async def plain_start(bench: Bench) -> PlainStart:
    """Start without parameters: which ones does it declare, and does Ctrl+C end it cleanly?"""
    async with bench.start(FILE, watch={TOPIC: TYPE}, expected_s=7.0) as run:  # goes first: it decides a lot on its own
        bench.report_progress(0.2, "asking for its parameters")
        node = await find_node(bench, run)
        declared = await run.parameters(ANSWER_S) if node else None
        bench.report_facts(PlainStart(run.trace(), declared, None))
        bench.report_progress(0.5, "waiting for a message, then pressing Ctrl+C")
        if node:
            await wait_for_message(run, TOPIC, TYPE, message_gap_s=MESSAGE_GAP_S)
        trace = run.trace()
        ended = await run.interrupt()
    return PlainStart(trace, declared, ended, () if declared is not None else await dump_if_stuck(bench, trace))


async def start_with_parameters(bench: Bench) -> ParameterStarts:
    """Start with each of the parameters given on the command line."""
    prefix = "Ahoy7"

    async def start_fast() -> RatedStart:
        fast = await _start_at_rate(bench, {PREFIX: prefix, RATE: LAUNCH_HZ})
        bench.report_facts(ParameterStarts(prefix, fast))
        return fast

    slow = _start_at_rate(bench, {RATE: SLOW_LAUNCH_HZ})
    return ParameterStarts(prefix, *await asyncio.gather(start_fast(), slow, _start_disabled(bench)))


async def _start_at_rate(bench: Bench, parameters: Mapping[str, Any]) -> RatedStart:
    hz: float = parameters[RATE]
    async with bench.start(FILE, parameters=parameters, watch={TOPIC: TYPE}, expected_s=5 / hz) as run:
        bench.report_progress(0.2, " ".join(f"{name}:={value}" for name, value in parameters.items()))
        # Longer than LAUNCH_HZ seconds, the period of a node that takes the rate for a period.
        if not await wait_for_message(run, TOPIC, TYPE, message_gap_s=LAUNCH_HZ + 1):
            return await _rated_start(run, hz, None, 0)
        since = run.samples_on(TOPIC)[0].source_time
        if PREFIX in parameters:
            await run.until(lambda: run.now() >= since + window_s(hz), window_s(hz) + 1.0, idle_s=IDLE_S)
            samples = run.samples_on(TOPIC)
            if find_without_prefix(samples, parameters[PREFIX]):  # it has failed, so a rough rate will do
                return await _rated_start(run, hz, measure(samples), len(samples))
        return await _rated_start(run, hz, *await measure_steady_rate(run, TOPIC, hz, since=since))


async def _rated_start(run: Run, hz: float, rate: Rate | None, messages: int) -> RatedStart:
    """The facts of a start at `hz`, whose rate was measured; a node that publishes at another one is asked for it."""
    trace = run.trace()
    took_rate = rate is not None and rate.agrees_with(hz)
    if not took_rate and run.exit is None and run.graph.parameter_nodes:
        took_rate = await read_parameters(run, (RATE,)) == (hz,)
    return RatedStart(trace, rate, messages, took_rate)


async def _start_disabled(bench: Bench) -> DisabledStart:
    parameters = {ENABLED: False, RATE: LAUNCH_HZ}
    async with bench.start(FILE, parameters=parameters, watch={TOPIC: TYPE}, expected_s=2.5) as run:
        bench.report_progress(0.3, f"{ENABLED}:=false, listening for silence")
        node = await find_node(bench, run)
        declared = await run.parameters(ANSWER_S) if node else None
        await wait_until_seen(run, lambda: has_publisher(run))
        since = run.now()
        # Two periods of the default rate, in case the rate given here has no effect.
        await run.until(
            lambda: bool(run.samples_on(TOPIC)) or run.now() - since >= 2.2 / DEFAULT_HZ, 4.0, idle_s=IDLE_S
        )
        trace, quiet_s, first_after_enable = run.trace(), run.now() - since, None
        if node and not trace.samples_on(TOPIC) and not has_publisher(run):
            # The node may create its publisher only once it is enabled.
            bench.report_progress(0.7, f"setting {ENABLED} to true")
            await run.set_parameters(node, {ENABLED: True}, limit_s=ANSWER_S)
            await wait_for_message(run, TOPIC, TYPE, message_gap_s=MESSAGE_GAP_S)
            first_after_enable = next(iter(run.samples_on(TOPIC)), None)
        return DisabledStart(trace, find_parameter(declared or (), ENABLED), quiet_s, first_after_enable)


async def launch_with_bad_rates(bench: Bench) -> tuple[Trace, ...]:
    """Start with each of the bad rates: does the node report which parameter is wrong?"""

    async def launch(bad: float) -> Trace:
        async with bench.start(FILE, parameters={RATE: bad}, watch={TOPIC: TYPE}, expected_s=0.5) as run:
            bench.report_progress(0.3, f"starting with {RATE}:={bad}")
            if await wait_until_seen(
                run, lambda: run.exit is not None or bool(messages_naming_rate(run.trace())), idle_s=IDLE_S
            ):
                await run.until(lambda: run.exit is not None, 1.0)  # the report may come in more than one message
            return run.trace()

    return tuple(await asyncio.gather(*(launch(bad) for bad in BAD_RATES)))
