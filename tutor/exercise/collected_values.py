"""The values of several starts without parameters, gathered until they show whether they are right, and random."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass

from tutor.exercise.nouns import Program, Topic
from tutor.exercise.publishing_start import PublishingStart, cancel
from tutor.exercise.rate_probes import ProbeRates
from tutor.judge import randomness
from tutor.judge.bench import Bench, MachineTooBusy, Run
from tutor.judge.series import is_int_in_float
from tutor.judge.trace import Trace
from tutor.judge.waiting_for_nodes import IDLE_S, MESSAGE_GAP_S, wait_for_message

MAX_COLLECT_S = 26.0
"""Longest value collection, counted from the first message: enough for a suspicious 1 Hz node to show plenty."""

MIN_COLLECT_S = 5.0
"""Shortest value collection: the other runs take this long anyway, and more values mean better evidence."""

MIN_VALUES = 3
"""Fewer values than this from a plain start show neither a pattern nor a range."""


@dataclass(frozen=True)
class CollectedValues:
    """The values from several starts without parameters, one tuple per run.

    `trace`: one of these runs, for wording a cause. `regular`: the values of a run at a higher rate; filled only if
    there are plenty and they are clearly not random.
    """

    runs: tuple[tuple[float, ...], ...]
    trace: Trace | None = None
    regular: tuple[float, ...] = ()

    @property
    def all(self) -> tuple[float, ...]:
        return tuple(value for run in self.runs for value in run)


def find_out_of_range(values: Iterable[float], topic: Topic) -> list[float]:
    """The values outside the topic's range, if it has one; NaN and the bits of an int are outside of any."""
    low, high = topic.low, topic.high
    if low is None or high is None:
        return []
    return [value for value in values if not low <= value <= high or is_int_in_float(value)]


@dataclass(frozen=True)
class CollectValues:
    """Collect values from two plain starts, and more if they look suspicious.

    Once the run at a higher rate has shown a pattern, there is no point in collecting more; nor once all runs, those
    with a parameter included, have sent one value again and again. `rate`: the starts with a parameter, if the exercise
    has a rate to be set.
    """

    program: Program
    topic: Topic
    rate: ProbeRates | None = None

    async def __call__(self, bench: Bench) -> CollectedValues:
        topic = self.topic
        counts: dict[Run, int] = {}
        fast = asyncio.ensure_future(self._regular_values(bench))
        probed: list[asyncio.Task[list[list[float]]]] = []

        def all_constant(values: list[float]) -> bool:
            if len(values) < MIN_VALUES or len(set(values)) > 1:
                return False
            if not probed:
                probed.append(asyncio.ensure_future(self.probed_values(bench)))
            others = probed[0].result() if probed[0].done() else []
            return randomness.are_all_constant([*map(topic.values, counts), *others])

        def enough(run: Run) -> bool:
            values = topic.values(run)
            if len(values) > counts.get(run, 0) and find_out_of_range(values, topic):
                bench.report_facts(CollectedValues((tuple(values),), run.trace()))
            counts[run] = len(values)
            bench.report_progress(min(len(values) / randomness.MIN_SAMPLE_SIZE, 1), f"{len(values)} values so far")
            # Both runs may send the same fixed list: only its second round would show that. Coarse values are judged by
            # few of them, so the run at a higher rate, which collects plenty, must have shown no pattern.
            suspicious = (
                randomness.needs_more_values(values)
                or any(randomness.may_be_one_sequence(values, topic.values(run_)) for run_ in counts if run_ is not run)
                or (randomness.are_coarse(values) and not fast.done())
            )
            decided = suspicious and fast.done() and bool(fast.result())
            return (
                (decided and len(values) >= MIN_VALUES)
                or len(values) >= randomness.FULL_SAMPLE_SIZE
                or (
                    (all_constant(values) or not suspicious)
                    and run.now() >= run.samples_on(topic.name)[0].source_time + MIN_COLLECT_S
                )
            )

        try:
            runs = await asyncio.gather(self.collect(bench, enough), self.collect(bench, enough))
            fast_values = fast.result() if fast.done() else ()
        finally:
            await cancel([fast, *probed])
        return CollectedValues(tuple(values for values, _ in runs), runs[0][1], fast_values)

    async def _regular_values(self, bench: Bench) -> tuple[float, ...]:
        """Return the values of the run at the highest rate if they are enough to prove a pattern, else ()."""
        if self.rate is not None:
            with suppress(MachineTooBusy):
                probe = await bench.facts(self.rate.fast)
                values = tuple(self.topic.values(probe.trace))
                pattern = randomness.find_pattern(values) if len(values) >= randomness.FULL_SAMPLE_SIZE else None
                if probe.agrees and pattern is not None and pattern.significant:
                    return values
        return ()

    async def probed_values(self, bench: Bench) -> list[list[float]]:
        """Return the values of each run in which a parameter that may be the rate was set."""
        if self.rate is not None:
            with suppress(MachineTooBusy):
                return [self.topic.values(probe.trace) for probe in (await bench.facts(self.rate)).probes]
        return []

    async def collect(self, bench: Bench, enough: Callable[[Run], bool]) -> tuple[tuple[float, ...], Trace]:
        """Start without parameters; return the values and the trace once `enough` holds, or no more messages come."""
        topic = self.topic
        received, waited_s = 0, 0.0

        def is_silent() -> bool:
            nonlocal received, waited_s
            samples = run.samples_on(topic.name)
            if len(samples) != received:
                received, waited_s = len(samples), run.node_cpu_wait_s()
            return run.now() >= samples[-1].received_at + MESSAGE_GAP_S + run.node_cpu_wait_s() - waited_s

        async with bench.start(self.program.file, watch=topic.watched, expected_s=1 + MIN_COLLECT_S) as run:
            if await wait_for_message(run, topic.name, topic.type):
                await run.until(lambda: enough(run) or is_silent(), MAX_COLLECT_S, idle_s=IDLE_S)
            return tuple(topic.values(run)), run.trace()


@dataclass(frozen=True)
class CollectMoreValues:
    """The values of the plain start; if one with a parameter went out of range, also plenty from two more plain starts.

    Values out of range may be intended when a parameter is set: they only tell us to look more closely.
    """

    values: CollectValues

    async def __call__(self, bench: Bench) -> CollectedValues:
        values, topic = self.values, self.values.topic
        plain = tuple(topic.values((await bench.facts(PublishingStart(values.program, topic))).trace))
        probed: list[float] = []
        if not find_out_of_range((*plain, *(await bench.facts(values)).all), topic):
            probed = [value for sent in await values.probed_values(bench) for value in sent]
        if not find_out_of_range(probed, topic):
            return CollectedValues((plain,))
        bench.report_progress(0.6, "listening longer: a start with a parameter gave a value that is out of range")

        def enough(run: Run) -> bool:
            sent = topic.values(run)
            return len(sent) >= randomness.FULL_SAMPLE_SIZE or bool(find_out_of_range(sent, topic))

        runs = await asyncio.gather(values.collect(bench, enough), values.collect(bench, enough))
        return CollectedValues((plain, *(sent for sent, _ in runs)), runs[0][1])
