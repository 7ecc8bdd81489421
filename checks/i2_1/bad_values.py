"""I2.1: the scenarios that ask the running node for values that it must reject."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from checks.i2_1.access import dump_if_stuck, read_base_hz, read_parameters, wait_until_publishing
from checks.i2_1.changes import measure_new_rate
from checks.i2_1.facts import (
    ANSWER_S,
    BAD_RATES,
    FILE,
    PREFIX,
    RATE,
    TOPIC,
    TYPE,
    VALIDATION_HZ,
    AtomicRequests,
    BadRates,
    text_of,
)
from tutor.judge.bench import Bench, Run
from tutor.judge.trace import SetAnswer
from tutor.judge.waiting import measure_steady_rate


async def ask_for_bad_rates(bench: Bench) -> BadRates:
    """Set bad rates, which must change nothing, on a node at a rate other than the default if it takes effect."""
    return await _try_bad_rates(bench, VALIDATION_HZ)


async def _try_bad_rates(bench: Bench, from_hz: float | None) -> BadRates:
    async with bench.start(FILE, watch={TOPIC: TYPE}, expected_s=4.2) as run:
        bench.report_progress(0.05, "waiting for it to publish")
        node, answering = await wait_until_publishing(bench, run)
        if node is None:
            return BadRates(
                trace := run.trace(), stuck=await dump_if_stuck(bench, trace, answering), answering=answering
            )
        base_hz = await read_base_hz(run)
        if from_hz is not None:
            refused = await _set_bad_rates(
                bench, run, node, base_hz
            )  # most nodes without validation show it right away
            if any(answer.successful or not answer.answered for answer, _ in refused.rejected):
                return refused
        if from_hz is None:
            return await _set_bad_rates_and_measure(bench, run, node, base_hz)
        good = await run.set_parameters(node, {RATE: from_hz}, limit_s=ANSWER_S)
        if good.answered and not good.successful:
            return replace(refused, trace=run.trace(), set_good=good)
        rate, _ = await measure_new_rate(run, good, from_hz, base_hz) if good.answered else (None, 0)
        if rate is not None and rate.agrees_with(from_hz):
            return replace(await _set_bad_rates_and_measure(bench, run, node, from_hz), rate_before=rate)
    # The effect of a good rate is judged elsewhere: bad ones must be rejected at the initial rate all the same.
    return await _try_bad_rates(bench, None)


async def _set_bad_rates_and_measure(bench: Bench, run: Run, node: str, base_hz: float) -> BadRates:
    """Set bad rates on a node that publishes at `base_hz`, and measure its rate afterwards."""
    seen = await _set_bad_rates(bench, run, node, base_hz)
    if not seen.rejected[-1][0].answered:
        return seen
    bench.report_progress(0.7, "measuring the rate after it")
    rate, messages = await measure_steady_rate(run, TOPIC, base_hz, since=seen.rejected[-1][0].answered_at)
    return replace(seen, trace=run.trace(), rate=rate, messages=messages)


async def _set_bad_rates(bench: Bench, run: Run, node: str, base_hz: float) -> BadRates:
    """Set each of the bad rates, but stop if the node does not answer."""
    (before,) = await read_parameters(run, (RATE,))
    rejected: list[tuple[SetAnswer, Any]] = []
    for bad in BAD_RATES:
        bench.report_progress(0.4, f"setting {RATE} to {bad}")
        answer = await run.set_parameters(node, {RATE: bad}, limit_s=ANSWER_S)
        if not answer.answered:
            rejected.append((answer, None))
            return BadRates(run.trace(), base_hz, before, tuple(rejected), stuck=await run.dump_stacks())
        rejected.append((answer, (await read_parameters(run, (RATE,)))[0]))
        bench.report_facts(BadRates(run.trace(), base_hz, before, tuple(rejected)))
    return BadRates(run.trace(), base_hz, before, tuple(rejected))


async def set_atomically(bench: Bench) -> AtomicRequests:
    """Set a good prefix and a bad rate in one atomic request, once in either order; then a good prefix and rate."""
    async with bench.start(FILE, watch={TOPIC: TYPE}, expected_s=5.0) as run:
        node, answering = await wait_until_publishing(bench, run)
        if node is None:
            return AtomicRequests(
                trace := run.trace(), stuck=await dump_if_stuck(bench, trace, answering), answering=answering
            )
        base_hz = await read_base_hz(run)
        before = await read_parameters(run, (PREFIX, RATE))
        tokens = ("Partial1", "Partial2")
        answers: list[SetAnswer] = []
        values: list[tuple[Any, ...]] = []
        for request in ({PREFIX: tokens[0], RATE: BAD_RATES[1]}, {RATE: BAD_RATES[1], PREFIX: tokens[1]}):
            bench.report_progress(0.4, f"setting {' and '.join(request)} atomically")
            answers.append(await run.set_parameters(node, request, atomic=True, limit_s=ANSWER_S))
            if not answers[-1].answered:
                return AtomicRequests(run.trace(), base_hz, tuple(answers), before, stuck=await run.dump_stacks())
            values.append(await read_parameters(run, (PREFIX, RATE)))
        rate, messages = await measure_steady_rate(run, TOPIC, base_hz, since=answers[-1].answered_at)
        shown = next((s for s in run.samples_on(TOPIC) if any(token in text_of(s) for token in tokens)), None)
        good = {PREFIX: "Whole1", RATE: VALIDATION_HZ}
        seen = AtomicRequests(run.trace(), base_hz, tuple(answers), before, tuple(values), shown, rate, messages)
        return replace(seen, set_good=await run.set_parameters(node, good, atomic=True, limit_s=ANSWER_S))
