"""Starts with parameters, which probe what sets the rate of a topic."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from tutor.exercise.nouns import Program, Topic
from tutor.exercise.publishing_start import AskForParameters, PublishingStart, cancel, numeric
from tutor.exercise.rate_units import (
    FAST_HZ,
    PROBE_VALUES,
    UNITS,
    RateProbe,
    RateProbes,
    are_inverted,
    count_agreeing,
    find_agreeing_groups,
    group_probes,
    has_known_unit,
    possible_units,
    values_to_probe,
)
from tutor.judge import randomness
from tutor.judge.bench import Bench, MachineTooBusy
from tutor.judge.rates import measure
from tutor.judge.trace import Trace
from tutor.judge.waiting_for_nodes import TRIES, cannot_be_slowed, too_few_by_cpu_wait, wait_for_message, window_s
from tutor.ros_model import Parameter

FAST_COLLECT_S = 4.0
"""Extra collection time for suspicious values at `FAST_HZ`: long enough for plenty of them."""


@dataclass(frozen=True)
class ProbeRate:
    """Start with a parameter set to a value, read in `unit`, and measure the rate.

    If the values look suspicious at `FAST_HZ`, plenty of them are collected here: at any other rate, that takes far
    longer. `as_integer`: pass the value as an integer.
    """

    program: Program
    topic: Topic
    name: str
    unit: str
    value: float
    as_integer: bool = False

    async def __call__(self, bench: Bench) -> RateProbe:
        topic, name, value = self.topic, self.name, self.value
        asked_hz = UNITS[self.unit](value)
        window = window_s(asked_hz)
        given, expected_s = {name: int(value) if self.as_integer else value}, 1 / asked_hz + window
        async with bench.start(self.program.file, parameters=given, watch=topic.watched, expected_s=expected_s) as run:
            bench.report_progress(0.2, f"{name}:={value:g}, measuring the rate")

            def measured() -> RateProbe:
                # The first gap may be irregular, for example if the node publishes once right at start-up.
                samples = run.samples_on(topic.name)
                overall, tail = measure(samples), measure(samples[1:])
                rate = tail if tail and tail.covers(window) and tail.agrees_with(asked_hz) else overall
                return RateProbe(name, self.unit, value, rate, len(samples), run.trace())

            def decided(min_s: float) -> bool:
                rate = measure(run.samples_on(topic.name))
                if rate is None:
                    return False
                # The window of a slow rate is long: far too many messages show well before its end.
                far_above = asked_hz < 1 and rate.is_far_above(asked_hz, window)
                return far_above or rate.span_s >= 0.95 * min_s or (rate.samples > 50 and rate.hz > 20)

            if not await wait_for_message(run, topic.name, topic.type):
                return measured()
            cpu_wait_s, since = run.node_cpu_wait_s(), run.now()
            for stretch in range(1, TRIES + 2):
                await run.until(lambda min_s=stretch * window: decided(min_s), window + 1 / asked_hz + 1)  # type: ignore[misc]
                probe = measured()
                lost_s, elapsed_s = run.node_cpu_wait_s() - cpu_wait_s, run.now() - since
                if (
                    probe.agrees
                    or run.exit is not None
                    or cannot_be_slowed(run.samples_on(topic.name)[1:], cpu_wait_s=lost_s, elapsed_s=elapsed_s)
                    or (probe.rate is not None and probe.rate.is_far_above(asked_hz, window))
                    or (
                        stretch > 1
                        and not too_few_by_cpu_wait(probe.messages, asked_hz, cpu_wait_s=lost_s, elapsed_s=elapsed_s)
                    )
                ):
                    break
            else:
                raise MachineTooBusy("this machine is too busy to measure a rate")
            bench.report_progress(1.0, f"{name}:={value:g} measured")
            if not probe.agrees or asked_hz != FAST_HZ:
                return probe
            if randomness.needs_more_values(values := topic.values(run)) or randomness.are_coarse(values):
                await run.until(lambda: len(topic.values(run)) >= randomness.FULL_SAMPLE_SIZE, FAST_COLLECT_S)
                return replace(probe, trace=run.trace())
            return probe


@dataclass(frozen=True)
class ProbeRates:
    """Start once for each probe value of each parameter that may be the rate.

    `suggested`, the skeleton's parameter name, is probed while the node is still asked for its parameters, since most
    nodes keep that name.
    """

    program: Program
    topic: Topic
    suggested: str

    @property
    def fast(self) -> ProbeRate:
        """The start at the highest rate to probe, set through the skeleton's parameter name."""
        return self._probe(self.suggested, "Hz", FAST_HZ)

    async def __call__(self, bench: Bench) -> RateProbes:
        under_way = {probe: asyncio.ensure_future(self._run(bench, probe)) for probe in self._suggested()}
        try:
            declared = await bench.facts(AskForParameters(self.program, self.topic))
            if declared is None or any(p.name == self.suggested for p in declared):
                return await self._probe_declared(bench, declared, under_way)
        finally:
            await cancel(under_way.values())
        return await self._probe_declared(bench, declared, {})

    def _probe(self, name: str, unit: str, value: float, as_integer: bool = False) -> ProbeRate:
        return ProbeRate(self.program, self.topic, name, unit, value, as_integer)

    def _suggested(self) -> list[ProbeRate]:
        return [self._probe(self.suggested, "Hz", value) for value in PROBE_VALUES["Hz"]]

    async def _run(self, bench: Bench, probe: ProbeRate) -> RateProbe:
        return await (bench.facts(probe) if probe == self.fast else probe(bench))

    async def _probe_declared(
        self, bench: Bench, declared: tuple[Parameter, ...] | None, under_way: dict[ProbeRate, asyncio.Task[RateProbe]]
    ) -> RateProbes:
        """Probe each declared parameter, and the skeleton's name if it is not among them.

        `under_way`: the probes already running, which are used (and removed from the dict) instead of starting them
        again.
        """
        tried: list[RateProbe] = []

        async def attempt(plan: Sequence[ProbeRate]) -> bool:
            # Stop early once all values of one parameter and unit agree, or once each parameter and unit has a probe
            # that disagrees plus another one to diagnose the cause from.
            wanted = Counter((probe.name, probe.unit) for probe in plan)

            def decided() -> bool:
                if any(len(group) == wanted[group[0].key] for group in find_agreeing_groups(tried)):
                    return True
                refuted = [
                    group for group in group_probes(tried) if len(group) > 1 and count_agreeing(group) < len(group)
                ]
                return wanted.keys() <= {group[0].key for group in refuted}

            pending = {
                under_way.pop(probe) if probe in under_way else asyncio.ensure_future(probe(bench)) for probe in plan
            }
            try:
                while pending and not decided():
                    done, pending = await asyncio.wait(pending, return_when=asyncio.FIRST_COMPLETED)
                    tried.extend(task.result() for task in done)
            finally:
                await cancel(pending)
            return bool(find_agreeing_groups(tried))

        candidates = numeric(declared or ())
        with_known_unit = [parameter for parameter in candidates if has_known_unit(parameter.name)]
        for group in (with_known_unit, *([other] for other in candidates if other not in with_known_unit)):
            if await attempt(list(self._plan(group))):
                return RateProbes(declared, tuple(tried))
            # One that sets the rate to the reciprocal of what its name says leaves no room for another that sets it
            # right.
            inverted = any(are_inverted(probes, min_measured=2) for probes in group_probes(tried))
            if group is with_known_unit and inverted:
                return RateProbes(declared, tuple(tried))
        plain = PublishingStart(self.program, self.topic)
        if not any(p.name == self.suggested for p in candidates) and (await bench.facts(plain)).messages_go_on:
            # The node may answer no parameter call, or accept parameters that it does not declare.
            if declared is not None:
                fast = await bench.facts(self.fast)
                if not fast.agrees and not _refused_a_double(fast.trace):
                    return RateProbes(declared, (*tried, fast))  # it does not, or not for this name
            if not await attempt(self._suggested()) and any(_refused_a_double(probe.trace) for probe in tried):
                tried = [probe for probe in tried if probe.name != self.suggested]
                await attempt([self._probe(self.suggested, "Hz", hz, True) for hz in PROBE_VALUES["Hz"] if hz >= 1])
        return RateProbes(declared, tuple(tried))

    def _plan(self, group: Sequence[Parameter]) -> Iterable[ProbeRate]:
        for parameter in group:
            for unit in possible_units(parameter.name):
                for value in values_to_probe(parameter, unit):
                    yield self._probe(parameter.name, unit, value, parameter.type == "integer")


def _refused_a_double(trace: Trace) -> bool:
    return any("InvalidParameterType" in line.text for line in trace.output)
