"""I1.1: the temperatures of several starts without parameters."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress

from checks.i1_1.facts import (
    FILE,
    MAX_COLLECT_S,
    MIN_COLLECT_S,
    MIN_VALUES,
    TOPIC,
    TYPE,
    CollectedValues,
    find_out_of_range,
)
from checks.i1_1.probes import probe_fast, probe_rates
from checks.i1_1.scenarios import cancel, plain_start, values_of
from tutor.judge import randomness
from tutor.judge.bench import Bench, MachineTooBusy, Run
from tutor.judge.trace import Trace
from tutor.judge.waiting import IDLE_S, MESSAGE_GAP_S, wait_for_message


async def collect_values(bench: Bench) -> CollectedValues:
    """Collect values from two plain starts, and more if they look suspicious.

    Once the run at a higher rate has shown a pattern, there is no point in collecting more; nor once all runs, those
    with a parameter included, have sent one value again and again.
    """
    counts: dict[Run, int] = {}
    fast = asyncio.ensure_future(_regular_values(bench))
    probed: list[asyncio.Task[list[list[float]]]] = []

    def all_constant(values: list[float]) -> bool:
        if len(values) < MIN_VALUES or len(set(values)) > 1:
            return False
        if not probed:
            probed.append(asyncio.ensure_future(_probed_values(bench)))
        others = probed[0].result() if probed[0].done() else []
        return randomness.are_all_constant([*map(values_of, counts), *others])

    def enough(run: Run) -> bool:
        values = values_of(run)
        if len(values) > counts.get(run, 0) and find_out_of_range(values):
            bench.report_facts(CollectedValues((tuple(values),), run.trace()))
        counts[run] = len(values)
        bench.report_progress(min(len(values) / randomness.MIN_SAMPLE_SIZE, 1), f"{len(values)} temperatures so far")
        # Both runs may send the same fixed list: only its second round would show that. Coarse values are judged by few
        # of them, so the run at a higher rate, which collects plenty, must have shown no pattern.
        suspicious = (
            randomness.needs_more_values(values)
            or any(randomness.may_be_one_sequence(values, values_of(other)) for other in counts if other is not run)
            or (randomness.are_coarse(values) and not fast.done())
        )
        decided = suspicious and fast.done() and bool(fast.result())
        return (
            (decided and len(values) >= MIN_VALUES)
            or len(values) >= randomness.FULL_SAMPLE_SIZE
            or (
                (all_constant(values) or not suspicious)
                and run.now() >= run.samples_on(TOPIC)[0].source_time + MIN_COLLECT_S
            )
        )

    try:
        runs = await asyncio.gather(_collect(bench, enough), _collect(bench, enough))
        fast_values = fast.result() if fast.done() else ()
    finally:
        await cancel([fast, *probed])
    return CollectedValues(tuple(values for values, _ in runs), runs[0][1], fast_values)


async def _regular_values(bench: Bench) -> tuple[float, ...]:
    """Return the values of the run at the highest rate if they are enough to prove a pattern, else ()."""
    with suppress(MachineTooBusy):
        probe = await bench.facts(probe_fast)
        values = tuple(values_of(probe.trace))
        pattern = randomness.find_pattern(values) if len(values) >= randomness.FULL_SAMPLE_SIZE else None
        if probe.agrees and pattern is not None and pattern.significant:
            return values
    return ()


async def _probed_values(bench: Bench) -> list[list[float]]:
    """Return the values of each run in which a parameter that may be the rate was set."""
    with suppress(MachineTooBusy):
        return [values_of(probe.trace) for probe in (await bench.facts(probe_rates)).probes]
    return []


async def collect_more_values(bench: Bench) -> CollectedValues:
    """Return the values of `plain_start`; if a rate probe went out of range, also plenty from two more plain starts.

    Values out of range may be intended when a parameter is set: they only tell us to look more closely.
    """
    plain = tuple(values_of((await bench.facts(plain_start)).trace))
    probed: list[float] = []
    if not find_out_of_range((*plain, *(await bench.facts(collect_values)).all)):
        probed = [value for values in await _probed_values(bench) for value in values]
    if not find_out_of_range(probed):
        return CollectedValues((plain,))
    bench.report_progress(0.6, "listening longer: a start with a parameter gave a temperature that is out of range")

    def enough(run: Run) -> bool:
        return len(values_of(run)) >= randomness.FULL_SAMPLE_SIZE or bool(find_out_of_range(values_of(run)))

    runs = await asyncio.gather(_collect(bench, enough), _collect(bench, enough))
    return CollectedValues((plain, *(values for values, _ in runs)), runs[0][1])


async def _collect(bench: Bench, enough: Callable[[Run], bool]) -> tuple[tuple[float, ...], Trace]:
    """Start without parameters and return the values and the trace once `enough` holds, or no more messages come."""
    received, waited_s = 0, 0.0

    def is_silent() -> bool:
        nonlocal received, waited_s
        samples = run.samples_on(TOPIC)
        if len(samples) != received:
            received, waited_s = len(samples), run.node_cpu_wait_s()
        return run.now() >= samples[-1].received_at + MESSAGE_GAP_S + run.node_cpu_wait_s() - waited_s

    async with bench.start(FILE, watch={TOPIC: TYPE}, expected_s=1 + MIN_COLLECT_S) as run:
        if await wait_for_message(run, TOPIC, TYPE):
            await run.until(lambda: enough(run) or is_silent(), MAX_COLLECT_S, idle_s=IDLE_S)
        return tuple(values_of(run)), run.trace()
