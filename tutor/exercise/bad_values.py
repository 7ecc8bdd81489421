"""Bad values that the running node is asked to take: one by one, or in an atomic request."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from tutor.exercise.node_parameters import ParameterNode, read, set_values
from tutor.exercise.nouns import Parameter, ShownIn, Value
from tutor.exercise.rate_at_run_time import measure_new_rate
from tutor.judge.bench import Bench, Run
from tutor.judge.rates import Rate
from tutor.judge.trace import Sample, SetAnswer, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting_for_nodes import measure_steady_rate


@dataclass(frozen=True)
class BadValues:
    """A start without parameters on which bad values are set.

    `before`: the value before that, and `rate_before` the measured rate, if it had just been set. `rejected`: each
    answer with the value afterwards. `rate`, `messages`: what the node publishes then. `set_good`: the answer to a good
    value, if it was rejected; nothing is measured then. `stuck`: the stack, innermost frame first, of a node that
    answered nothing; `answering`: a node answered although it published nothing.
    """

    trace: Trace
    base_hz: float = 1.0
    before: Any = 1.0
    rejected: tuple[tuple[SetAnswer, Any], ...] = ()
    rate: Rate | None = None
    messages: int = 0
    stuck: tuple[Frame, ...] = ()
    answering: bool = False
    rate_before: Rate | None = None
    set_good: SetAnswer | None = None


@dataclass(frozen=True)
class SetBadValues:
    """Set bad values, which must change nothing.

    `from_hz`: of a parameter that sets the rate, a good value other than the default; the node is asked while it
    publishes at this rate, if that takes effect.
    """

    node: ParameterNode
    parameter: Parameter
    bad: tuple[Value, ...]
    from_hz: float | None

    async def __call__(self, bench: Bench) -> BadValues:
        return await self._try(bench, self.from_hz)

    async def _try(self, bench: Bench, from_hz: float | None) -> BadValues:
        node = self.node
        async with bench.start(node.program.file, watch=node.topic.watched, expected_s=4.2) as run:
            name, answering = await node.wait_until_publishing(bench, run)
            if name is None:
                trace = run.trace()
                stuck = await node.dump_if_stuck(bench, trace, answering)
                return BadValues(trace, node.default_hz, self.parameter.default, stuck=stuck, answering=answering)
            base_hz = await node.read_base_hz(run)
            if from_hz is None:
                return await self._set_and_measure(bench, run, name, base_hz)
            refused = await self._set_bad(bench, run, name, base_hz)  # most nodes without validation show it right away
            if any(answer.successful or not answer.answered for answer, _ in refused.rejected):
                return refused
            good = await set_values(run, name, (self.parameter, from_hz))
            if good.answered and not good.successful:
                return replace(refused, trace=run.trace(), set_good=good)
            rate, _ = await measure_new_rate(run, node, good, from_hz, base_hz) if good.answered else (None, 0)
            if rate is not None and rate.agrees_with(from_hz):
                return replace(await self._set_and_measure(bench, run, name, from_hz), rate_before=rate)
        # The effect of a good rate is judged elsewhere: bad ones must be rejected at the initial rate all the same.
        return await self._try(bench, None)

    async def _set_and_measure(self, bench: Bench, run: Run, name: str, base_hz: float) -> BadValues:
        """Set bad values on a node that publishes at `base_hz`, and measure its rate afterwards."""
        seen = await self._set_bad(bench, run, name, base_hz)
        if not seen.rejected[-1][0].answered:
            return seen
        bench.report_progress(0.7, "measuring the rate after it")
        since = seen.rejected[-1][0].answered_at
        rate, messages = await measure_steady_rate(run, self.node.topic.name, base_hz, since=since)
        return replace(seen, trace=run.trace(), rate=rate, messages=messages)

    async def _set_bad(self, bench: Bench, run: Run, name: str, base_hz: float) -> BadValues:
        """Set each of the bad values, but stop if the node does not answer."""
        (before,) = await read(run, self.parameter)
        rejected: list[tuple[SetAnswer, Any]] = []
        for bad in self.bad:
            bench.report_progress(0.4, f"setting {self.parameter.name} to {bad}")
            answer = await set_values(run, name, (self.parameter, bad))
            if not answer.answered:
                rejected.append((answer, None))
                return BadValues(run.trace(), base_hz, before, tuple(rejected), stuck=await run.dump_stacks())
            rejected.append((answer, (await read(run, self.parameter))[0]))
            bench.report_facts(BadValues(run.trace(), base_hz, before, tuple(rejected)))
        return BadValues(run.trace(), base_hz, before, tuple(rejected))


@dataclass(frozen=True)
class AtomicRequests:
    """A start without parameters with two atomic requests that must be rejected.

    `before`, `values`: of both parameters before, and after each request. `shown`: a message with a rejected value.
    `set_good`: the answer to an atomic request of good values, made last. `stuck`, `answering`: see `BadValues`.
    """

    trace: Trace
    base_hz: float = 1.0
    answers: tuple[SetAnswer, ...] = ()
    before: tuple[Any, ...] = ()
    values: tuple[tuple[Any, ...], ...] = ()
    shown: Sample | None = None
    rate: Rate | None = None
    messages: int = 0
    stuck: tuple[Frame, ...] = ()
    answering: bool = False
    set_good: SetAnswer | None = None


@dataclass(frozen=True)
class SetAtomically:
    """Set a good and a bad value in one atomic request, once in either order; then two good ones.

    `tokens`: values of the parameter `shown`, for each request. `bad` and `good`: values of `other`.
    """

    node: ParameterNode
    shown: Parameter
    tokens: tuple[Value, Value, Value]
    other: Parameter
    bad: Value
    good: Value

    async def __call__(self, bench: Bench) -> AtomicRequests:
        node, effect, other = self.node, self.shown.effect, self.other
        assert isinstance(effect, ShownIn)
        async with bench.start(node.program.file, watch=node.topic.watched, expected_s=5.0) as run:
            name, answering = await node.wait_until_publishing(bench, run)
            if name is None:
                trace = run.trace()
                stuck = await node.dump_if_stuck(bench, trace, answering)
                return AtomicRequests(trace, node.default_hz, stuck=stuck, answering=answering)
            base_hz = await node.read_base_hz(run)
            before = await read(run, self.shown, other)
            answers: list[SetAnswer] = []
            values: list[tuple[Any, ...]] = []
            first, second, whole = ((self.shown, token) for token in self.tokens)
            for request in ((first, (other, self.bad)), ((other, self.bad), second)):
                bench.report_progress(0.4, f"setting {' and '.join(p.name for p, _ in request)} atomically")
                answers.append(await set_values(run, name, *request, atomic=True))
                if not answers[-1].answered:
                    return AtomicRequests(run.trace(), base_hz, tuple(answers), before, stuck=await run.dump_stacks())
                values.append(await read(run, self.shown, other))
            since = answers[-1].answered_at
            rate, messages = await measure_steady_rate(run, node.topic.name, base_hz, since=since)
            samples = run.samples_on(node.topic.name)
            shown = next((sample for sample in samples if any(effect.shows(t, sample) for t in self.tokens[:2])), None)
            seen = AtomicRequests(run.trace(), base_hz, tuple(answers), before, tuple(values), shown, rate, messages)
            return replace(seen, set_good=await set_values(run, name, whole, (other, self.good), atomic=True))
