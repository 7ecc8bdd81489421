"""A form: setting a parameter of the running node changes the rate, and leaves one timer."""

from __future__ import annotations

from dataclasses import dataclass

from tutor.exercise.defaults import DeclaringStart
from tutor.exercise.form import Exercise, Form, parameter_node
from tutor.exercise.node_parameters import ParameterNode, are_alike, fail_not_running, fail_not_set, set_values
from tutor.exercise.nouns import Parameter
from tutor.judge.bench import Bench, Run
from tutor.judge.check import Criterion
from tutor.judge.rates import TOLERANCE, Rate, describe, measure
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import SetAnswer, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.waiting_for_nodes import IDLE_S, IN_FLIGHT_S, measure_steady_rate, window_s


@dataclass(frozen=True)
class RateChanges:
    """A start without parameters on which the rate is set to a faster and then to a slower one.

    `steps`: for each change, the answer, the measured rate, and the number of messages it was measured from. `stuck`:
    the stack, innermost frame first, of a node that answered nothing; `answering`: a node answered although it
    published nothing.
    """

    trace: Trace
    steps: tuple[tuple[SetAnswer, Rate | None, int], ...] = ()
    stuck: tuple[Frame, ...] = ()
    answering: bool = False


@dataclass(frozen=True)
class ChangeRate:
    """Set a faster and then a slower rate, in Hz; each may take one period of the old rate to take effect.

    There is no need to wait for the first message: the start without parameters shows whether the node publishes at
    all.
    """

    node: ParameterNode
    rate: Parameter
    steps_hz: tuple[float, float]

    async def __call__(self, bench: Bench) -> RateChanges:
        seen = await self._change(bench, at_once=True)
        if all(answer.answered for answer, _, _ in seen.steps[:1]):
            return seen
        return await self._change(bench, at_once=False)  # the node may have had no timer yet

    async def _change(self, bench: Bench, *, at_once: bool) -> RateChanges:
        node, rate = self.node, self.rate
        async with bench.start(node.program.file, watch=node.topic.watched) as run:
            bench.report_progress(0.05, "waiting for it to publish")
            name = await node.wait_until_ready(bench, run, at_once=at_once)
            if name is None:
                return RateChanges(trace := run.trace(), stuck=await node.dump_if_stuck(bench, trace))
            steps: list[tuple[SetAnswer, Rate | None, int]] = []
            old_hz = await node.read_base_hz(run)
            for done, new_hz in zip((0.3, 0.6), self.steps_hz, strict=True):
                bench.report_progress(done, f"setting {rate.name} to {new_hz}")
                answer = await set_values(run, name, (rate, new_hz))
                plain = await bench.facts(DeclaringStart(node))
                if not plain.trace.samples_on(node.topic.name):
                    return RateChanges(plain.trace, stuck=plain.stuck, answering=plain.parameters is not None)
                if not answer.answered:
                    return RateChanges(run.trace(), (*steps, (answer, None, 0)), await run.dump_stacks())
                if not answer.successful:
                    return RateChanges(run.trace(), (*steps, (answer, None, 0)))
                measured, messages = await measure_new_rate(run, node, answer, new_hz, old_hz)
                steps.append((answer, measured, messages))
                if measured is not None and measured.agrees_with(node.default_hz):
                    break  # no effect, so the second change would have none either; in any other case, it tells more
                old_hz = new_hz
            return RateChanges(run.trace(), tuple(steps))


async def measure_new_rate(
    run: Run, node: ParameterNode, answer: SetAnswer, new_hz: float, old_hz: float
) -> tuple[Rate | None, int]:
    """Return the new rate, and the number of messages it is measured from.

    It may take one period of the old rate to take effect. Most nodes change at once: if the messages until then are
    enough to measure a higher rate, and it agrees, they decide.
    """
    settled = answer.answered_at + 1 / old_hz + 0.05
    window = window_s(new_hz)
    if new_hz > old_hz:
        measurable = max(settled, answer.answered_at + window) + IN_FLIGHT_S
        await run.until(lambda: run.now() >= measurable, window + 1 / old_hz + 1, idle_s=IDLE_S)
        samples = [sample for sample in run.samples_on(node.topic.name) if sample.source_time >= answer.answered_at]
        rate = measure(samples)
        if rate is not None and rate.agrees_with(new_hz) and rate.covers(window):
            return rate, len(samples)
    await run.until(lambda: run.now() >= settled, 1 / old_hz + 1, idle_s=IDLE_S)
    return await measure_steady_rate(run, node.topic.name, new_hz, since=settled)


@dataclass(frozen=True)
class RateAtRunTime(Form):
    """Setting the parameter of the running node changes the measured rate, up and down, and one timer is left.

    `steps_hz`: a faster and then a slower rate than the default. Rates of 0.5 to 10 Hz are measured well; a forgotten
    timer of 1 Hz beside a new one of 10 Hz stays within the tolerance, so the slower one should be below the default.
    """

    rate: Parameter
    steps_hz: tuple[float, float]

    def criterion(self, exercise: Exercise) -> Criterion:
        node = parameter_node(exercise)
        return self.judged(lambda seen: self.judge(seen, node), ChangeRate(node, self.rate, self.steps_hz))

    def judge(self, seen: RateChanges, node: ParameterNode) -> Verdict:
        """Judge the changes of the rate."""
        name, (up, down) = self.rate.name, self.steps_hz
        expected = f"setting {name} changes the measured rate: {up} Hz, then {down} Hz, ±{TOLERANCE:.0%}"
        if not seen.steps:
            return fail_not_running(node, expected, seen.trace, seen.stuck, seen.answering)
        for answer, rate, messages in seen.steps:
            asked = answer.values[name]
            if not answer.answered or not answer.successful:
                return fail_not_set(expected, answer, seen.trace, seen.stuck)
            if rate is None or not rate.agrees_with(asked):
                observed = f"{name} set to {asked}: {describe(rate, messages)}"
                return failed(expected, observed, self._wrong_rate(seen, asked, rate))
        return passed(expected, ", then ".join(str(rate) for _, rate, _ in seen.steps))

    def _wrong_rate(self, seen: RateChanges, asked: float, rate: Rate | None) -> Observation:
        default_hz, (up, down) = float(self.rate.default), self.steps_hz
        before = default_hz if asked == up else up
        faster = seen.steps[0][1]
        left_behind = asked == down and faster is not None and faster.hz > up + default_hz / 2
        as_before = rate is not None and rate.agrees_with(before) and not left_behind
        followed = asked == down and faster is not None and faster.agrees_with(up)
        same = rate is not None and rate.hz < up and all(are_alike(rate, other) for _, other, _ in seen.steps)
        return Symptom.WRONG_RATE.seen(
            seen.trace,
            parameter=self.rate.name,
            wanted_hz=asked,
            rate=rate,
            unchanged=as_before or same,
            inverted=rate is None or rate.agrees_with(1 / asked),
            at_start=False,
            followed_hz=up if followed else None,
            earlier_hz=(default_hz,) if asked == up else (default_hz, up),
        )
