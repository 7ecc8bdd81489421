"""Good values that are set while the node runs: what is published before, meanwhile and afterwards."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, replace

from tutor.exercise.node_parameters import ParameterNode, set_values
from tutor.exercise.nouns import Parameter, ShownIn, Value
from tutor.judge.bench import Bench, Run
from tutor.judge.rates import Rate, measure
from tutor.judge.trace import Sample, SetAnswer, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting_for_nodes import IDLE_S, measure_steady_rate

QUIET_PERIODS = 1.3
"""A node that still publishes sends a message within this many periods, even with some jitter."""

SECOND_TIMER_PERIODS = 0.25
"""How much longer than the messages themselves to listen for those of a second timer, in periods."""

FAST_HZ = 10.0
"""The rate that is set while nothing is published: a node that it switches on shows that soon."""


@dataclass(frozen=True)
class RunTimeChanges:
    """A start without parameters on which these are set: a shown value, a switch off, another value, the switch on.

    Some facts come from another start. `set_true`: the answer to the switch set to true, which it was, right after the
    value; `went_on`: whether messages came afterwards; `inverts`: they did not, but did once it was set to true again.
    `after_value`: the first message with the new value; `before`: the rate up to then; `sent_after_rate`: the messages
    sent although the switch was off, after the rate was set.
    `resumed`: the first message after the switch was on again. `after_resume`: the messages from then on or from a
    period later, with their `rate`. `stuck`: the stack, innermost frame first, of a node that answered nothing;
    `answering`: a node answered although it published nothing.
    """

    trace: Trace
    base_hz: float = 1.0
    set_value: SetAnswer | None = None
    set_true: SetAnswer | None = None
    went_on: bool = True
    inverts: bool = False
    after_value: Sample | None = None
    set_off: SetAnswer | None = None
    sent_while_off: tuple[Sample, ...] = ()
    sent_after_rate: tuple[Sample, ...] = ()
    set_later: SetAnswer | None = None
    set_on: SetAnswer | None = None
    resumed: Sample | None = None
    before: Rate | None = None
    after_resume: tuple[Sample, ...] = ()
    rate: Rate | None = None
    stuck: tuple[Frame, ...] = ()
    answering: bool = False

    @property
    def period_s(self) -> float:
        """The time between two messages, in seconds."""
        return 1 / self.base_hz


@dataclass(frozen=True)
class ChangeAtRunTime:
    """Set a shown parameter at run time, and on another start a switch as well. A change may take one period to show.

    `value` and `later`: what is set at first, and while the switch is off. `switch`: None if there is none to set.
    """

    node: ParameterNode
    shown: Parameter
    value: Value
    later: Value
    switch: Parameter | None

    async def __call__(self, bench: Bench) -> RunTimeChanges:
        if self.switch is None:
            return await self._set_value(bench)
        switching = asyncio.ensure_future(self._switch_off_and_on(bench, self.switch))
        try:
            with_value = await self._set_value(bench)
            if with_value.after_value is None or not with_value.went_on:
                return with_value
            switched = await switching
        finally:
            switching.cancel()
            await asyncio.gather(switching, return_exceptions=True)
        return replace(
            switched,
            set_true=with_value.set_true,
            after_value=with_value.after_value,
            before=with_value.before,
            sent_after_rate=with_value.sent_after_rate,
        )

    def _shows(self, value: Value, sample: Sample) -> bool:
        assert isinstance(self.shown.effect, ShownIn)
        return self.shown.effect.shows(value, sample)

    async def _set_value(self, bench: Bench) -> RunTimeChanges:
        """Set the value, and the switch to true, while the node publishes; then the rate while the switch is off."""
        node, topic, switch = self.node, self.node.topic.name, self.switch
        async with bench.start(node.program.file, watch=node.topic.watched, expected_s=3.0) as run:
            name, answering = await node.wait_until_publishing(bench, run)
            if name is None:
                trace = run.trace()
                stuck = await node.dump_if_stuck(bench, trace, answering)
                return RunTimeChanges(trace, node.default_hz, stuck=stuck, answering=answering)
            seen = RunTimeChanges(run.trace(), await node.read_base_hz(run))
            bench.report_progress(0.2, f"setting {self.shown.name} to {self.value}")
            answer = await set_values(run, name, (self.shown, self.value))
            seen, last = replace(seen, set_value=answer), answer
            if answer.successful and switch is not None:
                last = await set_values(run, name, (switch, True))
                seen = replace(seen, set_true=last)
            if not last.answered:
                return replace(seen, trace=run.trace(), stuck=await run.dump_stacks())
            if not last.successful:
                return replace(seen, trace=run.trace())
            due = answer.answered_at + seen.period_s + 0.1

            def goes_on() -> bool:
                return any(sample.source_time > last.answered_at for sample in run.samples_on(topic))

            def with_value() -> Sample | None:
                since = [sample for sample in run.samples_on(topic) if sample.source_time > answer.asked_at]
                return next((sample for sample in since if self._shows(self.value, sample)), None)

            def overdue() -> bool:
                """Whether a message has shown the old value when it could no longer."""
                return any(
                    sample.source_time > due and not self._shows(self.value, sample) for sample in run.samples_on(topic)
                )

            await run.until(
                lambda: goes_on() and (with_value() is not None or overdue()), 2 * seen.period_s + 2, idle_s=IDLE_S
            )
            before = measure(run.samples_on(topic))
            seen = replace(seen, after_value=with_value(), before=before, went_on=goes_on())
            if not seen.went_on:
                if switch is not None:
                    await set_values(run, name, (switch, True))
                inverts = await run.until(goes_on, seen.period_s + 1, idle_s=IDLE_S)
                return replace(seen, inverts=inverts, trace=run.trace())
            if seen.after_value is not None and switch is not None and node.rate is not None:
                bench.report_progress(0.6, f"setting {node.rate.name} to {FAST_HZ} while {switch.name} is false")
                sent = await self._set_rate_while_off(run, name, switch, node.rate, seen.period_s)
                seen = replace(seen, sent_after_rate=sent)
            return replace(seen, trace=run.trace())

    async def _set_rate_while_off(
        self, run: Run, name: str, switch: Parameter, rate: Parameter, period_s: float
    ) -> tuple[Sample, ...]:
        """Switch off and then set a higher rate; return what is published in spite of it."""
        set_off = await set_values(run, name, (switch, False))
        if not set_off.successful:
            return ()
        set_rate = await set_values(run, name, (rate, FAST_HZ))
        quiet_from = max(set_off.answered_at + period_s, set_rate.answered_at) + 0.1
        quiet_until = quiet_from + 3 / FAST_HZ
        await run.until(lambda: run.now() >= quiet_until, period_s + 2, idle_s=IDLE_S)
        return tuple(sample for sample in run.samples_on(self.node.topic.name) if sample.source_time > quiet_from)

    async def _switch_off_and_on(self, bench: Bench, switch: Parameter) -> RunTimeChanges:
        """Set the value and switch off; then set another value and switch on again."""
        seen = await self._switch(bench, switch, at_once=True)
        if all(answer is None or answer.answered for answer in (seen.set_value, seen.set_off)):
            return seen
        return await self._switch(bench, switch, at_once=False)  # the node may have had no timer yet

    async def _switch(self, bench: Bench, switch: Parameter, *, at_once: bool) -> RunTimeChanges:
        node, topic = self.node, self.node.topic.name
        async with bench.start(node.program.file, watch=node.topic.watched) as run:
            name = await node.wait_until_ready(bench, run, at_once=at_once)
            if name is None:
                return RunTimeChanges(run.trace(), node.default_hz)
            seen = RunTimeChanges(run.trace(), await node.read_base_hz(run), answering=True)
            set_value = await set_values(run, name, (self.shown, self.value))
            seen = replace(seen, set_value=set_value)
            if not set_value.answered:
                return replace(seen, trace=run.trace(), stuck=await run.dump_stacks())
            bench.report_progress(0.4, f"setting {switch.name} to false, listening for silence")
            set_off = await set_values(run, name, (switch, False))
            seen = replace(seen, trace=run.trace(), set_off=set_off)
            if not set_off.answered:
                return replace(seen, trace=run.trace(), stuck=await run.dump_stacks())
            if not set_off.successful:
                return seen
            quiet_from = set_off.answered_at + seen.period_s + 0.1

            def unwanted() -> list[Sample]:
                return [sample for sample in run.samples_on(topic) if sample.source_time > quiet_from]

            quiet_until = quiet_from + QUIET_PERIODS * seen.period_s
            # An idle node sends nothing more by itself: it stays silent.
            await run.until(lambda: bool(unwanted()) or run.now() >= quiet_until, 3 * seen.period_s + 2, idle_s=IDLE_S)
            sent = tuple(unwanted())
            bench.report_progress(0.6, f"setting {self.shown.name} to {self.later}, then {switch.name} to true")
            seen = replace(seen, trace=run.trace(), sent_while_off=sent)
            if sent:
                return seen
            seen = replace(seen, set_later=await set_values(run, name, (self.shown, self.later)))
            if seen.set_later is not None and not seen.set_later.answered:
                return replace(seen, trace=run.trace(), stuck=await run.dump_stacks())
            set_on = await set_values(run, name, (switch, True))

            def resumed() -> Sample | None:
                return next((sample for sample in run.samples_on(topic) if sample.source_time > set_on.asked_at), None)

            await run.until(lambda: resumed() is not None, 2 * seen.period_s + 2, idle_s=IDLE_S)
            bench.report_progress(0.8, "checking that it goes on as before")
            since = set_on.answered_at + seen.period_s + 0.1
            seen = replace(seen, set_on=set_on, resumed=resumed())
            after_resume, rate = await self._measure_resumed(run, seen, since) if seen.resumed else ((), None)
            return replace(seen, trace=run.trace(), after_resume=after_resume, rate=rate)

    async def _measure_resumed(
        self, run: Run, seen: RunTimeChanges, since: float
    ) -> tuple[tuple[Sample, ...], Rate | None]:
        """Return the messages after the switch was on again, and their rate.

        If all is well with the first two messages, just over one period is enough: a second timer would send a third
        one. Otherwise only the messages from `since` on count, because the node may take that long to settle; if
        needed, the rate is then measured for longer.
        """
        assert seen.resumed is not None
        topic, hz, first = self.node.topic.name, seen.base_hz, seen.resumed.source_time

        def received(since: float = since) -> tuple[Sample, ...]:
            return tuple(sample for sample in run.samples_on(topic) if sample.source_time >= since)

        for messages in (2, 3):
            limit_s = (messages - 1 + SECOND_TIMER_PERIODS) / hz
            await run.until(lambda until=first + limit_s: run.now() >= until, limit_s + 2)  # type: ignore[misc]
            early = received(first)
            rate = measure(early)
            are_right = all(self._shows(self.later, sample) and not self._shows(self.value, sample) for sample in early)
            if are_right and len(early) == messages and rate is not None and rate.agrees_with(hz):
                return early, rate
        await run.until(lambda: run.now() >= since + 2.2 / hz, 3.5 / hz + 2)
        rate = measure(received())
        if rate is None or not rate.agrees_with(hz):
            rate, _ = await measure_steady_rate(run, topic, hz, since=run.now())
        return received(), rate
