"""I2.1: the scenarios, which start the node and gather the facts."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from checks.i2_1.facts import (
    ANSWER_S,
    BAD_RATES,
    DEFAULT_HZ,
    DEFAULTS,
    DOWN_HZ,
    ENABLED,
    FILE,
    LAUNCH_HZ,
    MESSAGE_GAP_S,
    PREFIX,
    RATE,
    SLOW_LAUNCH_HZ,
    TOPIC,
    TYPE,
    UP_HZ,
    VALIDATION_HZ,
    AtomicRequests,
    BadRates,
    ParameterStarts,
    PlainStart,
    RateChanges,
    RuntimeChanges,
    find_parameter,
    messages_naming_rate,
    text_of,
)
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import repeat_if_doubtful
from tutor.judge.rates import Rate, measure
from tutor.judge.trace import Sample, SetAnswer, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting import (
    IDLE_S,
    IN_FLIGHT_S,
    RESENT_S,
    START_S,
    find_stuck_frames,
    measure_steady_rate,
    wait_for_message,
    wait_for_publisher,
    wait_until_seen,
    window_s,
)
from tutor.ros_model import Parameter

QUIET_PERIODS = 1.3
"""A node that still publishes sends a message within this many periods, even with some jitter."""

SECOND_TIMER_PERIODS = 0.25
"""How much longer than the messages themselves to listen for those of a second timer, in periods."""


@repeat_if_doubtful
async def plain_start(bench: Bench) -> PlainStart:
    """Start without parameters: which ones does it declare, and does Ctrl+C end it cleanly?"""
    async with bench.start(FILE, watch={TOPIC: TYPE}, expected_s=7.0) as run:  # goes first: it decides a lot on its own
        bench.report_progress(0.2, "asking for its parameters")
        node = await _find_node(run)
        declared = await run.parameters(ANSWER_S) if node else None
        bench.report_facts(PlainStart(run.trace(), declared, None))
        bench.report_progress(0.5, "waiting for a message, then pressing Ctrl+C")
        if node:
            await wait_for_message(run, TOPIC, TYPE, message_gap_s=MESSAGE_GAP_S)
        trace = run.trace()
        ended = await run.interrupt() if run.exit is None else None
    return PlainStart(trace, declared, ended, () if declared is not None else await _find_stuck_frames(bench, trace))


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
            node = await _find_node(run)
            declared = await run.parameters(ANSWER_S) if node else None
            await wait_until_seen(run, lambda: _has_publisher(run))
            since = run.now()
            # Two periods of the default rate, in case the rate given here has no effect.
            await run.until(
                lambda: bool(run.samples_on(TOPIC)) or run.now() - since >= 2.2 / DEFAULT_HZ, 4.0, idle_s=IDLE_S
            )
            trace, quiet_s, first_after_enable = run.trace(), run.now() - since, None
            if node and not trace.samples_on(TOPIC) and not _has_publisher(run):
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


async def switch_at_runtime(bench: Bench) -> RuntimeChanges:
    """Set message_prefix at run time, and on another start `enabled` as well. A change may take one period to show."""
    switching = asyncio.ensure_future(_switch_enabled(bench))
    try:
        prefixed = await _set_prefix(bench)
        if prefixed.after_prefix is None:
            return prefixed
        switched = await switching
    finally:
        switching.cancel()
        await asyncio.gather(switching, return_exceptions=True)
    return replace(switched, after_prefix=prefixed.after_prefix, before=prefixed.before)


async def _set_prefix(bench: Bench) -> RuntimeChanges:
    """Set message_prefix while the node publishes."""
    async with bench.start(FILE, watch={TOPIC: TYPE}, expected_s=3.0) as run:
        bench.report_progress(0.05, "waiting for it to publish")
        node, answering = await _wait_until_publishing(run)
        if node is None:
            return RuntimeChanges(
                trace := run.trace(), stuck=await _find_stuck_frames(bench, trace, answering), answering=answering
            )
        seen = RuntimeChanges(run.trace(), await _read_base_hz(run))
        bench.report_progress(0.2, f"setting {PREFIX} to {seen.prefix}")
        answer = await run.set_parameters(node, {PREFIX: seen.prefix}, limit_s=ANSWER_S)
        if not answer.answered:
            return replace(seen, trace=run.trace(), set_prefix=answer, stuck=await run.dump_stacks())
        if not answer.successful:
            return replace(seen, trace=run.trace(), set_prefix=answer)
        due = answer.answered_at + seen.period_s + 0.1

        def with_new_prefix() -> Sample | None:
            since = answer.asked_at
            return next((s for s in run.samples_on(TOPIC) if s.source_time > since and seen.prefix in text_of(s)), None)

        def overdue_with_old_prefix() -> Sample | None:
            return next(
                (s for s in run.samples_on(TOPIC) if s.source_time > due and seen.prefix not in text_of(s)), None
            )

        await run.until(
            lambda: with_new_prefix() is not None or overdue_with_old_prefix() is not None,
            2 * seen.period_s + 2,
            idle_s=IDLE_S,
        )
        before = measure(run.samples_on(TOPIC))
        return replace(seen, trace=run.trace(), set_prefix=answer, after_prefix=with_new_prefix(), before=before)


async def _switch_enabled(bench: Bench) -> RuntimeChanges:
    """Set message_prefix and switch `enabled` off; then set another prefix and switch it on again."""
    seen = await _switch(bench, at_once=True)
    answers = (seen.set_prefix, seen.set_off)
    if all(answer is None or answer.answered for answer in answers):
        return seen
    return await _switch(bench, at_once=False)  # the node may have had no timer yet


async def _switch(bench: Bench, *, at_once: bool) -> RuntimeChanges:
    async with bench.start(FILE, watch={TOPIC: TYPE}) as run:
        node = await _wait_until_ready(run, at_once=at_once)
        if node is None:
            return RuntimeChanges(run.trace())
        seen = RuntimeChanges(run.trace(), await _read_base_hz(run), answering=True)
        set_prefix = await run.set_parameters(node, {PREFIX: seen.prefix}, limit_s=ANSWER_S)
        if not set_prefix.answered:
            return replace(seen, trace=run.trace(), set_prefix=set_prefix, stuck=await run.dump_stacks())
        bench.report_progress(0.4, f"setting {ENABLED} to false, listening for silence")
        set_off = await run.set_parameters(node, {ENABLED: False}, limit_s=ANSWER_S)
        seen = replace(seen, trace=run.trace(), set_prefix=set_prefix, set_off=set_off)
        if not set_off.answered:
            return replace(seen, trace=run.trace(), stuck=await run.dump_stacks())
        if not set_off.successful:
            return seen
        quiet_from = set_off.answered_at + seen.period_s + 0.1

        def unwanted() -> list[Sample]:
            return [s for s in run.samples_on(TOPIC) if s.source_time > quiet_from]

        quiet_until = quiet_from + QUIET_PERIODS * seen.period_s
        # An idle node sends nothing more by itself: it stays silent.
        await run.until(lambda: bool(unwanted()) or run.now() >= quiet_until, 3 * seen.period_s + 2, idle_s=IDLE_S)
        sent = tuple(unwanted())
        bench.report_progress(0.6, f"setting {PREFIX} to {seen.later}, then {ENABLED} to true")
        seen = replace(seen, trace=run.trace(), sent_while_off=sent)
        if sent:
            return seen
        set_later = await run.set_parameters(node, {PREFIX: seen.later}, limit_s=ANSWER_S)
        if not set_later.answered:
            return replace(seen, trace=run.trace(), set_later=set_later, stuck=await run.dump_stacks())
        set_on = await run.set_parameters(node, {ENABLED: True}, limit_s=ANSWER_S)

        def resumed() -> Sample | None:
            return next((s for s in run.samples_on(TOPIC) if s.source_time > set_on.asked_at), None)

        await run.until(lambda: resumed() is not None, 2 * seen.period_s + 2, idle_s=IDLE_S)
        bench.report_progress(0.8, "checking that it goes on as before")
        since = set_on.answered_at + seen.period_s + 0.1
        seen = replace(seen, set_later=set_later, set_on=set_on, resumed=resumed())
        after_resume, rate = await _measure_resumed(run, seen, since=since) if seen.resumed is not None else ((), None)
        return replace(seen, trace=run.trace(), after_resume=after_resume, rate=rate)


async def _measure_resumed(run: Run, seen: RuntimeChanges, *, since: float) -> tuple[tuple[Sample, ...], Rate | None]:
    """Return the messages after `enabled` was switched on again, and their rate.

    If all is well with the first two messages, just over one period is enough: a second timer would send a third one.
    Otherwise only the messages from `since` on count, because the node may take that long to settle; if needed, the
    rate is then measured for longer.
    """
    assert seen.resumed is not None
    hz, first = seen.base_hz, seen.resumed.source_time

    def received(since: float = since) -> tuple[Sample, ...]:
        return tuple(sample for sample in run.samples_on(TOPIC) if sample.source_time >= since)

    for messages in (2, 3):
        limit_s = (messages - 1 + SECOND_TIMER_PERIODS) / hz
        await run.until(lambda until=first + limit_s: run.now() >= until, limit_s + 2)  # type: ignore[misc]
        early = received(first)
        rate = measure(early)
        texts_are_right = all(seen.later in text and seen.prefix not in text for text in map(text_of, early))
        if texts_are_right and len(early) == messages and rate is not None and rate.agrees_with(hz):
            return early, rate
    await run.until(lambda: run.now() >= since + 2.2 / hz, 3.5 / hz + 2)
    rate = measure(received())
    if rate is None or not rate.agrees_with(hz):
        rate, _ = await measure_steady_rate(run, TOPIC, hz, since=run.now())
    return received(), rate


async def ask_for_bad_rates(bench: Bench) -> BadRates:
    """Set bad rates, which must change nothing, on a node at a rate other than the default if it accepts one."""
    return await _try_bad_rates(bench, VALIDATION_HZ)


async def _try_bad_rates(bench: Bench, from_hz: float | None) -> BadRates:
    async with bench.start(FILE, watch={TOPIC: TYPE}, expected_s=4.2) as run:
        bench.report_progress(0.05, "waiting for it to publish")
        node, answering = await _wait_until_publishing(run)
        if node is None:
            return BadRates(
                trace := run.trace(), stuck=await _find_stuck_frames(bench, trace, answering), answering=answering
            )
        base_hz = await _read_base_hz(run)
        if from_hz is not None:
            refused = await _set_bad_rates(
                bench, run, node, base_hz
            )  # most nodes without validation show it right away
            if any(answer.successful or not answer.answered for answer, _ in refused.rejected):
                return refused
        if from_hz is None or await _accepts_rate(run, node, from_hz, base_hz):
            return await _set_bad_rates_and_measure(bench, run, node, from_hz or base_hz)
    # Accepting a good rate is judged elsewhere: a node that does not must still reject bad ones at its initial rate.
    return await _try_bad_rates(bench, None)


async def _accepts_rate(run: Run, node: str, new_hz: float, old_hz: float) -> bool:
    """Set a rate; return whether the node accepts it and publishes at it."""
    answer = await run.set_parameters(node, {RATE: new_hz}, limit_s=ANSWER_S)
    if not answer.answered or not answer.successful:
        return False
    rate, _ = await _measure_new_rate(run, answer, new_hz, old_hz)
    return rate is not None and rate.agrees_with(new_hz)


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
    (before,) = await _read_parameters(run, (RATE,))
    rejected: list[tuple[SetAnswer, Any]] = []
    for bad in BAD_RATES:
        bench.report_progress(0.4, f"setting {RATE} to {bad}")
        answer = await run.set_parameters(node, {RATE: bad}, limit_s=ANSWER_S)
        if not answer.answered:
            rejected.append((answer, None))
            return BadRates(run.trace(), base_hz, before, tuple(rejected), stuck=await run.dump_stacks())
        rejected.append((answer, (await _read_parameters(run, (RATE,)))[0]))
        bench.report_facts(BadRates(run.trace(), base_hz, before, tuple(rejected)))
    return BadRates(run.trace(), base_hz, before, tuple(rejected))


async def change_rate(bench: Bench) -> RateChanges:
    """Set a faster and then a slower rate; each may take one period of the old rate to take effect.

    There is no need to wait for the first message: the plain start shows whether the node publishes at all.
    """
    seen = await _change_rate(bench, at_once=True)
    if all(answer.answered for answer, _, _ in seen.steps[:1]):
        return seen
    return await _change_rate(bench, at_once=False)  # the node may have had no timer yet


async def _change_rate(bench: Bench, *, at_once: bool) -> RateChanges:
    async with bench.start(FILE, watch={TOPIC: TYPE}) as run:
        bench.report_progress(0.05, "waiting for it to publish")
        node = await _wait_until_ready(run, at_once=at_once)
        if node is None:
            return RateChanges(trace := run.trace(), stuck=await _find_stuck_frames(bench, trace))
        steps: list[tuple[SetAnswer, Rate | None, int]] = []
        old_hz = await _read_base_hz(run)
        for done, new_hz in ((0.3, UP_HZ), (0.6, DOWN_HZ)):
            bench.report_progress(done, f"setting {RATE} to {new_hz}")
            answer = await run.set_parameters(node, {RATE: new_hz}, limit_s=ANSWER_S)
            plain = await bench.facts(plain_start)
            if not plain.trace.samples_on(TOPIC):
                return RateChanges(plain.trace, stuck=plain.stuck, answering=plain.parameters is not None)
            if not answer.answered:
                return RateChanges(run.trace(), (*steps, (answer, None, 0)), await run.dump_stacks())
            if not answer.successful:
                return RateChanges(run.trace(), (*steps, (answer, None, 0)))
            rate, messages = await _measure_new_rate(run, answer, new_hz, old_hz)
            steps.append((answer, rate, messages))
            if rate is not None and rate.agrees_with(DEFAULT_HZ):
                break  # no effect, so the second change would have none either; in any other case, it tells more
            old_hz = new_hz
        return RateChanges(run.trace(), tuple(steps))


async def _measure_new_rate(run: Run, answer: SetAnswer, new_hz: float, old_hz: float) -> tuple[Rate | None, int]:
    """Return the new rate, and the number of messages it is measured from.

    It may take one period of the old rate to take effect. Most nodes change at once: if the messages until then are
    enough to measure a higher rate, and it agrees, they decide.
    """
    settled = answer.answered_at + 1 / old_hz + 0.05
    window = window_s(new_hz)
    if new_hz > old_hz:
        measurable = max(settled, answer.answered_at + window) + IN_FLIGHT_S
        await run.until(lambda: run.now() >= measurable, window + 1 / old_hz + 1, idle_s=IDLE_S)
        samples = [sample for sample in run.samples_on(TOPIC) if sample.source_time >= answer.answered_at]
        rate = measure(samples)
        if rate is not None and rate.agrees_with(new_hz) and rate.covers(window):
            return rate, len(samples)
    await run.until(lambda: run.now() >= settled, 1 / old_hz + 1, idle_s=IDLE_S)
    return await measure_steady_rate(run, TOPIC, new_hz, since=settled)


async def set_atomically(bench: Bench) -> AtomicRequests:
    """Set a good prefix and a bad rate in one atomic request, once in either order."""
    async with bench.start(FILE, watch={TOPIC: TYPE}, expected_s=5.0) as run:
        node, answering = await _wait_until_publishing(run)
        if node is None:
            return AtomicRequests(
                trace := run.trace(), stuck=await _find_stuck_frames(bench, trace, answering), answering=answering
            )
        base_hz = await _read_base_hz(run)
        before = await _read_parameters(run, (PREFIX, RATE))
        tokens = ("Partial1", "Partial2")
        answers: list[SetAnswer] = []
        values: list[tuple[Any, ...]] = []
        for request in ({PREFIX: tokens[0], RATE: BAD_RATES[1]}, {RATE: BAD_RATES[1], PREFIX: tokens[1]}):
            bench.report_progress(0.4, f"setting {' and '.join(request)} atomically")
            answers.append(await run.set_parameters(node, request, atomic=True, limit_s=ANSWER_S))
            if not answers[-1].answered:
                return AtomicRequests(run.trace(), base_hz, tuple(answers), before, stuck=await run.dump_stacks())
            values.append(await _read_parameters(run, (PREFIX, RATE)))
        rate, messages = await measure_steady_rate(run, TOPIC, base_hz, since=answers[-1].answered_at)
        shown = next((s for s in run.samples_on(TOPIC) if any(token in text_of(s) for token in tokens)), None)
        return AtomicRequests(run.trace(), base_hz, tuple(answers), before, tuple(values), shown, rate, messages)


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


async def dump_silent_node(bench: Bench) -> tuple[Frame, ...]:
    """Start without parameters and return the node's stack while it answers nothing."""
    return await find_stuck_frames(bench, FILE)


async def _find_stuck_frames(bench: Bench, trace: Trace, answering: bool = False) -> tuple[Frame, ...]:
    """Return the stack of a node that, according to this trace, is up but does nothing and answers nothing; else ()."""
    return await bench.facts(dump_silent_node) if trace.graph.nodes and trace.exit is None and not answering else ()


async def _find_node(run: Run) -> str | None:
    """Find the node to talk to: the one with most of the required parameters. None if no node answers."""
    if not await run.until(lambda: bool(run.graph.parameter_nodes), START_S, idle_s=RESENT_S):
        return None
    declared = await run.parameters(ANSWER_S)
    if declared is None:
        return None
    holders = [parameter.node for parameter in declared if parameter.name in DEFAULTS]
    return max(holders or run.graph.parameter_nodes, key=holders.count, default=None)


async def _wait_until_publishing(run: Run) -> tuple[str | None, bool]:
    """Return the node to talk to once it publishes (None if it does not), and whether it answers."""
    node = await _find_node(run)
    publishes = node is not None and await wait_for_message(run, TOPIC, TYPE, message_gap_s=MESSAGE_GAP_S)
    return (node if publishes else None), node is not None


async def _wait_until_ready(run: Run, *, at_once: bool) -> str | None:
    """Return the node to talk to once it publishes, or with `at_once`, as soon as it has its publisher.

    None if no node answers.
    """
    node = await _find_node(run)
    if node is not None and not at_once:
        await wait_for_message(run, TOPIC, TYPE, message_gap_s=MESSAGE_GAP_S)
    elif node is not None:
        await wait_for_publisher(run, TOPIC, TYPE)
    return node


def _has_publisher(run: Run) -> bool:
    return any(publisher.topic == TOPIC for publisher in run.graph.publishers)


async def _read_parameters(run: Run, names: Sequence[str]) -> tuple[Any, ...]:
    """Read these parameters; None for each that the node does not have."""
    declared = await run.parameters(ANSWER_S) or ()
    found = [find_parameter(declared, name) for name in names]
    return tuple(parameter.value if parameter else None for parameter in found)


async def _read_base_hz(run: Run) -> float:
    """Read the rate that the node starts at: 1.0 Hz, or a wrong default from 0.5 to 10 Hz."""
    value = (await _read_parameters(run, (RATE,)))[0]
    return float(value) if isinstance(value, (int, float)) and 0.5 <= value <= 10 else DEFAULT_HZ
