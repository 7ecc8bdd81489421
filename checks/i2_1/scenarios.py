"""I2.1: the scenarios that start the node and gather the facts of its start."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import Any

from checks.i2_1.access import dump_if_stuck, find_node, has_publisher
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
    ParameterStarts,
    PlainStart,
    find_parameter,
    messages_naming_rate,
)
from tutor.judge.bench import Bench
from tutor.judge.ending import repeat_if_doubtful
from tutor.judge.rates import Rate
from tutor.judge.trace import Sample, Trace
from tutor.judge.waiting import IDLE_S, measure_steady_rate, wait_for_message, wait_until_seen
from tutor.ros_model import Parameter


@repeat_if_doubtful
async def plain_start(bench: Bench) -> PlainStart:
    """Start without parameters: which ones does it declare, and does Ctrl+C end it cleanly?"""
    async with bench.start(FILE, watch={TOPIC: TYPE}, expected_s=7.0) as run:  # goes first: it decides a lot on its own
        bench.report_progress(0.2, "asking for its parameters")
        node = await find_node(run)
        declared = await run.parameters(ANSWER_S) if node else None
        bench.report_facts(PlainStart(run.trace(), declared, None))
        bench.report_progress(0.5, "waiting for a message, then pressing Ctrl+C")
        if node:
            await wait_for_message(run, TOPIC, TYPE, message_gap_s=MESSAGE_GAP_S)
        trace = run.trace()
        ended = await run.interrupt() if run.exit is None else None
    return PlainStart(trace, declared, ended, () if declared is not None else await dump_if_stuck(bench, trace))


async def start_with_parameters(bench: Bench) -> ParameterStarts:
    """Start with each of the parameters given on the command line."""
    prefix = "Ahoy7"

    async def loud(hz: float, more: Mapping[str, Any]) -> tuple[Trace, Rate | None, int]:
        parameters = {**more, RATE: hz}
        async with bench.start(FILE, parameters=parameters, watch={TOPIC: TYPE}, expected_s=5 / hz) as run:
            bench.report_progress(0.2, " ".join(f"{name}:={value}" for name, value in parameters.items()))
            # Longer than LAUNCH_HZ seconds, the period of a node that takes the rate for a period.
            if not await wait_for_message(run, TOPIC, TYPE, message_gap_s=LAUNCH_HZ + 1):
                return run.trace(), None, 0
            rate, messages = await measure_steady_rate(run, TOPIC, hz, since=run.samples_on(TOPIC)[0].source_time)
            return run.trace(), rate, messages

    async def silent() -> tuple[Trace, Parameter | None, float, Sample | None]:
        parameters = {ENABLED: False, RATE: LAUNCH_HZ}
        async with bench.start(FILE, parameters=parameters, watch={TOPIC: TYPE}, expected_s=2.5) as run:
            bench.report_progress(0.3, f"{ENABLED}:=false, listening for silence")
            node = await find_node(run)
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
            return trace, find_parameter(declared or (), ENABLED), quiet_s, first_after_enable

    (
        (trace, rate, messages),
        (slow, slow_rate, slow_messages),
        (disabled, answer, quiet_s, first_after_enable),
    ) = await asyncio.gather(loud(LAUNCH_HZ, {PREFIX: prefix}), loud(SLOW_LAUNCH_HZ, {}), silent())
    return ParameterStarts(
        prefix, trace, rate, messages, slow, slow_rate, slow_messages, disabled, answer, quiet_s, first_after_enable
    )


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
