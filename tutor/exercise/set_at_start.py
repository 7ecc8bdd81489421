"""A form: parameters that are given at start-up take effect."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tutor.exercise.form import Exercise, Form, parameter_node
from tutor.exercise.node_parameters import (
    ANSWER_S,
    MESSAGE_GAP_S,
    ParameterNode,
    are_alike,
    find_parameter,
    read,
    set_values,
)
from tutor.exercise.nouns import Parameter, SetsRate, ShownIn, SwitchesOff, Topic, Value
from tutor.judge import tracebacks
from tutor.judge.bench import Bench, Run
from tutor.judge.check import Criterion
from tutor.judge.rates import TOLERANCE, Rate, describe, measure
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Sample, Trace
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.waiting_for_nodes import IDLE_S, measure_steady_rate, wait_for_message, wait_until_seen, window_s
from tutor.judge.wording import counted, output_tail
from tutor.ros_model import Parameter as Reported


@dataclass(frozen=True)
class Given:
    """The parameters that a program is started with."""

    values: tuple[tuple[Parameter, Value], ...]

    @property
    def arguments(self) -> dict[str, Value]:
        """The values by name."""
        return {parameter.name: value for parameter, value in self.values}

    @property
    def rate(self) -> tuple[Parameter, float] | None:
        """The parameter that sets the rate, and the rate in Hz."""
        return next(((p, float(value)) for p, value in self.values if isinstance(p.effect, SetsRate)), None)

    @property
    def shown(self) -> tuple[Parameter, ShownIn, Value] | None:
        """The parameter that messages show, where, and its value."""
        return next(((p, p.effect, value) for p, value in self.values if isinstance(p.effect, ShownIn)), None)

    @property
    def topic(self) -> Topic:
        """The topic on which the effects show."""
        return next(parameter.effect.topic for parameter, _ in self.values if parameter.effect is not None)

    @property
    def switch(self) -> Parameter | None:
        """The parameter that is given as false, so that nothing is published."""
        return next((p for p, value in self.values if isinstance(p.effect, SwitchesOff) and value is False), None)

    def find_without(self, samples: Sequence[Sample]) -> list[Sample]:
        """Those of the last two messages without the value: an earlier one may have been sent before it was read."""
        if self.shown is None:
            return []
        _, effect, value = self.shown
        return [sample for sample in samples[-2:] if not effect.shows(value, sample)]

    def __str__(self) -> str:
        return " ".join(f"{p.name}:={str(v).lower() if isinstance(v, bool) else v}" for p, v in self.values)


@dataclass(frozen=True)
class Started:
    """A start with parameters.

    `rate`: measured, if one was given, from this number of `messages`; `took_rate`: the node took it: it publishes at
    it, or reports it as the parameter's value. With a switch as false, `reported` is what the node reports of it, and
    `quiet_s` how long, in seconds, its silence was observed; `first_after_enable`: its first message once it is
    switched on, tried only if it began without a publisher.
    """

    trace: Trace
    rate: Rate | None = None
    messages: int = 0
    took_rate: bool = False
    reported: Reported | None = None
    quiet_s: float = 0.0
    first_after_enable: Sample | None = None


@dataclass(frozen=True)
class StartedWithParameters:
    """Starts with parameters, in the order of the form's; None for each that has not ended yet."""

    starts: tuple[Started | None, ...]

    @property
    def took_rate(self) -> bool:
        """Whether the node took a good rate at start-up."""
        return any(start is not None and start.took_rate for start in self.starts)


@dataclass(frozen=True)
class StartWithParameters:
    """Start once with each of these sets of parameters."""

    node: ParameterNode
    starts: tuple[Given, ...]

    async def __call__(self, bench: Bench) -> StartedWithParameters:
        first, *others = self.starts

        async def start_first() -> Started:
            started = await self._start(bench, first)
            bench.report_facts(StartedWithParameters((started, *(None for _ in others))))
            return started

        return StartedWithParameters(
            tuple(await asyncio.gather(start_first(), *(self._start(bench, given) for given in others)))
        )

    async def _start(self, bench: Bench, given: Given) -> Started:
        return await (self._listen(bench, given) if given.switch is None else self._hear_silence(bench, given))

    async def _listen(self, bench: Bench, given: Given) -> Started:
        node, topic = self.node, self.node.topic
        hz = given.rate[1] if given.rate is not None else node.default_hz
        async with bench.start(
            node.program.file, parameters=given.arguments, watch=topic.watched, expected_s=5 / hz
        ) as run:
            bench.report_progress(0.2, str(given))
            # Longer than the period, in seconds, of a node that takes the rate for a period.
            gap_s = max((start.rate[1] for start in self.starts if start.rate), default=MESSAGE_GAP_S) + 1
            if not await wait_for_message(run, topic.name, topic.type, message_gap_s=gap_s):
                return await self._started(run, given, None, 0)
            since = run.samples_on(topic.name)[0].source_time
            if given.shown is not None:
                await run.until(lambda: run.now() >= since + window_s(hz), window_s(hz) + 1.0, idle_s=IDLE_S)
                samples = run.samples_on(topic.name)
                # What does not show the value has failed, so a rough rate will do.
                if given.rate is None or given.find_without(samples):
                    return await self._started(run, given, measure(samples), len(samples))
            return await self._started(run, given, *await measure_steady_rate(run, topic.name, hz, since=since))

    async def _started(self, run: Run, given: Given, rate: Rate | None, messages: int) -> Started:
        """The facts of a start; a node that publishes at another rate than the given one is asked for it."""
        trace, took_rate = run.trace(), False
        if given.rate is not None:
            parameter, hz = given.rate
            took_rate = rate is not None and rate.agrees_with(hz)
            if not took_rate and run.exit is None and run.graph.parameter_nodes:
                took_rate = await read(run, parameter) == (hz,)
        return Started(trace, rate, messages, took_rate)

    async def _hear_silence(self, bench: Bench, given: Given) -> Started:
        node, topic = self.node, self.node.topic
        switch = given.switch
        assert switch is not None
        async with bench.start(
            node.program.file, parameters=given.arguments, watch=topic.watched, expected_s=2.5
        ) as run:
            bench.report_progress(0.3, f"{switch.name}:=false, listening for silence")
            name = await node.find(bench, run)
            declared = await run.parameters(ANSWER_S) if name else None
            await wait_until_seen(run, lambda: topic.has_publisher(run))
            since = run.now()
            # Two periods of the default rate, in case the rate given here has no effect.
            await run.until(
                lambda: bool(run.samples_on(topic.name)) or run.now() - since >= 2.2 / node.default_hz,
                4.0,
                idle_s=IDLE_S,
            )
            trace, quiet_s, first_after_enable = run.trace(), run.now() - since, None
            if name and not trace.samples_on(topic.name) and not topic.has_publisher(run):
                # The node may create its publisher only once it is enabled.
                bench.report_progress(0.7, f"setting {switch.name} to true")
                await set_values(run, name, (switch, True))
                await node.wait_for_message(run)
                first_after_enable = next(iter(run.samples_on(topic.name)), None)
            reported = find_parameter(declared or (), switch)
            return Started(trace, reported=reported, quiet_s=quiet_s, first_after_enable=first_after_enable)


@dataclass(frozen=True)
class SetAtStart(Form):
    """Parameters given at start-up (`--ros-args -p name:=value`) take effect.

    `starts`: for each start, the parameters and the values that it is given. What a parameter's effect is says what
    must be seen: the value in the messages, the rate, or silence while a switch is false. A failure of the first start
    that publishes is reported before the others are over. Give one start two things at once, such as a text and a
    rate, and another a rate that shows rounding: 1.5 Hz is out of tolerance from 1 and 2 Hz.
    """

    starts: tuple[Mapping[Parameter, Value], ...]

    @property
    def _given(self) -> tuple[Given, ...]:
        return tuple(Given(tuple(start.items())) for start in self.starts)

    @property
    def _expected(self) -> str:
        *most, last = dict.fromkeys(parameter.name for start in self.starts for parameter in start)
        names = f"{', '.join(most)} and {last}" if most else last
        return f"--ros-args -p sets {names}, and each takes effect"

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(
            self.judge, StartWithParameters(parameter_node(exercise), self._given), early=self.judge_so_far
        )

    def judge(self, seen: StartedWithParameters) -> Verdict:
        """Judge all starts; those that are not over yet show nothing."""
        observed: list[str] = []
        for number, (given, start) in enumerate(zip(self._given, seen.starts, strict=True)):
            if start is None:
                continue
            if failure := self._judge_start(number, start, seen):
                return failure
            samples = start.trace.samples_on(given.topic.name)
            silence = f"silence for {start.quiet_s:.1f} s"
            shown = f'"{given.topic.value(samples[-1])}" at {start.rate}' if samples else silence
            observed.append(f"with {given}: {shown}")
        return passed(self._expected, "; ".join(observed))

    def judge_so_far(self, seen: StartedWithParameters) -> Verdict | None:
        """Judge by the first start alone, where the others can show nothing more about why it fails."""
        given, start = self._given[0], seen.starts[0]
        if start is None or given.switch is not None or self._judge_start(0, start, seen) is None:
            return None
        samples = start.trace.samples_on(given.topic.name)
        is_rate_wrong = bool(samples) and not given.find_without(samples)
        rates = [other for given, other in zip(self._given, seen.starts, strict=True) if given.switch is None]
        return None if is_rate_wrong and None in rates else self.judge(seen)

    def _judge_start(self, number: int, start: Started, seen: StartedWithParameters) -> Verdict | None:
        """Return the failure that a start shows; those before it showed none."""
        given, before = self._given[number], self._given[:number]
        if given.switch is not None:
            return self._judge_silence(given, given.switch, start)
        topic, samples = given.topic, start.trace.samples_on(given.topic.name)
        if not samples and (not before or given.rate is None):
            missing = Symptom.NO_MESSAGES.seen(start.trace, topic=topic.name, type=topic.type)
            observed = f"with {given}: no message on {topic.name}"
            return failed(self._expected, observed, missing, output_tail(start.trace))
        if without := given.find_without(samples):
            assert given.shown is not None
            ignored = _ignored(given.shown[0], start.trace)
            shown = [str(given.topic.value(sample)) for sample in samples[:6]]
            return failed(self._expected, f'with {given}: "{given.topic.value(without[-1])}"', ignored, shown)
        if given.rate is None or (start.rate is not None and start.rate.agrees_with(given.rate[1])):
            return None
        parameter, hz = given.rate
        alike = start.rate is not None and any(
            other and are_alike(start.rate, other.rate) for other in seen.starts if other is not start
        )
        is_default = start.rate is not None and start.rate.agrees_with(float(parameter.default))
        wrong = Symptom.WRONG_RATE.seen(
            start.trace,
            parameter=parameter.name,
            wanted_hz=hz,
            rate=start.rate,
            unchanged=(is_default or alike) and not any(earlier.rate for earlier in before),  # these were followed
            inverted=start.rate is None or start.rate.agrees_with(1 / hz),
            at_start=True,
        )
        measured = describe(start.rate, start.messages)
        return failed(self._expected, f"with {given}: {measured}, not {hz} Hz ±{TOLERANCE:.0%}", wrong)

    def _judge_silence(self, given: Given, switch: Parameter, start: Started) -> Verdict | None:
        trace, topic = start.trace, given.topic.name
        if loud := trace.samples_on(topic):
            shown = [str(given.topic.value(sample)) for sample in loud[:3]]
            observed = f"with {given}: {counted(len(loud), 'message')}"
            return failed(self._expected, observed, _ignored(switch, trace), shown)
        broken = trace.exit is not None or tracebacks.last_traceback(trace) is not None or not trace.graph.nodes
        held = start.reported.value if start.reported else None
        offered = any(publisher.topic == topic for publisher in trace.graph.publishers)
        # A silent node with a publisher is disabled even if it answers no parameter call; one without a publisher must
        # also send messages once it is enabled.
        silent_on_purpose = held in (False, None) if offered else held is False and start.first_after_enable is not None
        if not broken and silent_on_purpose:
            return None
        observed = f"with {given}: silence, but not because {switch.name} is false"
        return failed(self._expected, observed, _ignored(switch, trace), output_tail(trace))


def _ignored(parameter: Parameter, trace: Trace) -> Observation:
    return Symptom.CHANGE_IGNORED.seen(trace, parameter=parameter.name, at_start=True)
