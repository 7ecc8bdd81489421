"""I2.1: the scenarios that change good values while the node runs."""

from __future__ import annotations

import asyncio
from dataclasses import replace

from checks.i2_1.access import dump_if_stuck, read_base_hz, wait_until_publishing, wait_until_ready
from checks.i2_1.facts import (
    ANSWER_S,
    DEFAULT_HZ,
    DOWN_HZ,
    ENABLED,
    FILE,
    PREFIX,
    RATE,
    TOPIC,
    TYPE,
    UP_HZ,
    RateChanges,
    RuntimeChanges,
    text_of,
)
from checks.i2_1.scenarios import plain_start
from tutor.judge.bench import Bench, Run
from tutor.judge.rates import Rate, measure
from tutor.judge.trace import Sample, SetAnswer
from tutor.judge.waiting import IDLE_S, IN_FLIGHT_S, measure_steady_rate, window_s

QUIET_PERIODS = 1.3
"""A node that still publishes sends a message within this many periods, even with some jitter."""

SECOND_TIMER_PERIODS = 0.25
"""How much longer than the messages themselves to listen for those of a second timer, in periods."""


async def switch_at_runtime(bench: Bench) -> RuntimeChanges:
    """Set message_prefix at run time, and on another start `enabled` as well. A change may take one period to show."""
    switching = asyncio.ensure_future(_switch_enabled(bench))
    try:
        prefixed = await _set_prefix(bench)
        if prefixed.after_prefix is None or not prefixed.went_on:
            return prefixed
        switched = await switching
    finally:
        switching.cancel()
        await asyncio.gather(switching, return_exceptions=True)
    return replace(
        switched,
        set_true=prefixed.set_true,
        after_prefix=prefixed.after_prefix,
        before=prefixed.before,
        sent_after_rate=prefixed.sent_after_rate,
    )


async def _set_prefix(bench: Bench) -> RuntimeChanges:
    """Set message_prefix, and `enabled` to true, while the node publishes; then publish_rate while `enabled` is off."""
    async with bench.start(FILE, watch={TOPIC: TYPE}, expected_s=3.0) as run:
        bench.report_progress(0.05, "waiting for it to publish")
        node, answering = await wait_until_publishing(bench, run)
        if node is None:
            return RuntimeChanges(
                trace := run.trace(), stuck=await dump_if_stuck(bench, trace, answering), answering=answering
            )
        seen = RuntimeChanges(run.trace(), await read_base_hz(run))
        bench.report_progress(0.2, f"setting {PREFIX} to {seen.prefix}")
        answer = await run.set_parameters(node, {PREFIX: seen.prefix}, limit_s=ANSWER_S)
        if not answer.answered:
            return replace(seen, trace=run.trace(), set_prefix=answer, stuck=await run.dump_stacks())
        if not answer.successful:
            return replace(seen, trace=run.trace(), set_prefix=answer)
        set_true = await run.set_parameters(node, {ENABLED: True}, limit_s=ANSWER_S)
        seen = replace(seen, set_prefix=answer, set_true=set_true)
        if not set_true.answered:
            return replace(seen, trace=run.trace(), stuck=await run.dump_stacks())
        if not set_true.successful:
            return replace(seen, trace=run.trace())
        due = answer.answered_at + seen.period_s + 0.1

        def goes_on() -> bool:
            return any(sample.source_time > set_true.answered_at for sample in run.samples_on(TOPIC))

        def with_new_prefix() -> Sample | None:
            since = answer.asked_at
            return next((s for s in run.samples_on(TOPIC) if s.source_time > since and seen.prefix in text_of(s)), None)

        def overdue_with_old_prefix() -> Sample | None:
            return next(
                (s for s in run.samples_on(TOPIC) if s.source_time > due and seen.prefix not in text_of(s)), None
            )

        await run.until(
            lambda: goes_on() and (with_new_prefix() is not None or overdue_with_old_prefix() is not None),
            2 * seen.period_s + 2,
            idle_s=IDLE_S,
        )
        before = measure(run.samples_on(TOPIC))
        seen = replace(seen, after_prefix=with_new_prefix(), before=before, went_on=goes_on())
        if not seen.went_on:
            await run.set_parameters(node, {ENABLED: True}, limit_s=ANSWER_S)
            return replace(seen, inverts=await run.until(goes_on, seen.period_s + 1, idle_s=IDLE_S), trace=run.trace())
        if seen.after_prefix is not None:
            bench.report_progress(0.6, f"setting {RATE} to {UP_HZ} while {ENABLED} is false")
            seen = replace(seen, sent_after_rate=await _set_rate_while_off(run, node, seen.period_s))
        return replace(seen, trace=run.trace())


async def _set_rate_while_off(run: Run, node: str, period_s: float) -> tuple[Sample, ...]:
    """Set `enabled` to false and then a higher rate; return what is published in spite of it."""
    set_off = await run.set_parameters(node, {ENABLED: False}, limit_s=ANSWER_S)
    if not set_off.successful:
        return ()
    set_rate = await run.set_parameters(node, {RATE: UP_HZ}, limit_s=ANSWER_S)
    quiet_from = max(set_off.answered_at + period_s, set_rate.answered_at) + 0.1
    quiet_until = quiet_from + 3 / UP_HZ
    await run.until(lambda: run.now() >= quiet_until, period_s + 2, idle_s=IDLE_S)
    return tuple(sample for sample in run.samples_on(TOPIC) if sample.source_time > quiet_from)


async def _switch_enabled(bench: Bench) -> RuntimeChanges:
    """Set message_prefix and switch `enabled` off; then set another prefix and switch it on again."""
    seen = await _switch(bench, at_once=True)
    answers = (seen.set_prefix, seen.set_off)
    if all(answer is None or answer.answered for answer in answers):
        return seen
    return await _switch(bench, at_once=False)  # the node may have had no timer yet


async def _switch(bench: Bench, *, at_once: bool) -> RuntimeChanges:
    async with bench.start(FILE, watch={TOPIC: TYPE}) as run:
        node = await wait_until_ready(bench, run, at_once=at_once)
        if node is None:
            return RuntimeChanges(run.trace())
        seen = RuntimeChanges(run.trace(), await read_base_hz(run), answering=True)
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
        node = await wait_until_ready(bench, run, at_once=at_once)
        if node is None:
            return RateChanges(trace := run.trace(), stuck=await dump_if_stuck(bench, trace))
        steps: list[tuple[SetAnswer, Rate | None, int]] = []
        old_hz = await read_base_hz(run)
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
            rate, messages = await measure_new_rate(run, answer, new_hz, old_hz)
            steps.append((answer, rate, messages))
            if rate is not None and rate.agrees_with(DEFAULT_HZ):
                break  # no effect, so the second change would have none either; in any other case, it tells more
            old_hz = new_hz
        return RateChanges(run.trace(), tuple(steps))


async def measure_new_rate(run: Run, answer: SetAnswer, new_hz: float, old_hz: float) -> tuple[Rate | None, int]:
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
