"""I2.1: the verdicts on parameters that are set while the node runs."""

from __future__ import annotations

from typing import Any

from checks.i2_1.facts import (
    DEFAULT_HZ,
    DOWN_HZ,
    ENABLED,
    MIN_BURST,
    PREFIX,
    RATE,
    TOPIC,
    UP_HZ,
    RateChanges,
    RuntimeChanges,
    text_of,
)
from checks.i2_1.failures import (
    are_alike,
    fail_not_running,
    fail_not_set,
    rate_is_unchanged,
)
from tutor.judge.rates import TOLERANCE, Rate, describe
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Trace
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.wording import counted, output_tail

EXPECTED_CHANGES = f"setting {PREFIX} and {ENABLED} on the running node takes effect within one period"


def judge_changes(seen: RuntimeChanges) -> Verdict:
    """Judge `runtime-params`, apart from a rate that differs afterwards: `timer` may show why."""
    if seen.set_prefix is None:
        return fail_not_running(seen, EXPECTED_CHANGES)
    for answer in (seen.set_prefix, seen.set_true, seen.set_off, seen.set_later, seen.set_on):
        if answer is not None and not (answer.answered and answer.successful):
            return fail_not_set(EXPECTED_CHANGES, answer, seen.trace, seen.stuck)
    expected = EXPECTED_CHANGES
    if not seen.went_on:
        return _fail_silenced(seen)
    if seen.after_prefix is None:
        return failed(
            expected,
            f'{PREFIX} set to {seen.prefix}, but the messages still read "{_last_text(seen.trace)}"',
            Symptom.CHANGE_IGNORED.seen(seen.trace, parameter=PREFIX),
        )
    if seen.sent_while_off:
        return failed(
            expected,
            f"{ENABLED} set to false, but {counted(len(seen.sent_while_off), 'message')} more than a period later",
            Symptom.CHANGE_IGNORED.seen(seen.trace, parameter=ENABLED),
            [text_of(s) for s in seen.sent_while_off[:3]],
        )
    if seen.resumed is None:
        observed = f"{ENABLED} set to false and to true again: no message since"
        return failed(expected, observed, _changed(seen.trace, ENABLED, "does not resume"))
    assert seen.set_on is not None
    return _fail_if_not_as_before(seen, expected, any_rate=True) or passed(
        expected,
        f'"{text_of(seen.after_prefix)}"; silence while false; resumed '
        f"{seen.resumed.source_time - seen.set_on.asked_at:.2f} s after true",
    )


def _fail_silenced(seen: RuntimeChanges) -> Verdict:
    """Fail a node that sends nothing more once `enabled` is set to true, which it was already."""
    observed = f"{PREFIX} set to {seen.prefix}, and {ENABLED} to true, which it was already: no message since"
    how = "inverted" if seen.inverts else "stops"
    return failed(EXPECTED_CHANGES, observed, _changed(seen.trace, ENABLED, how), output_tail(seen.trace))


def _changed(trace: Trace, parameter: str, how: str, **about: Any) -> Observation:
    """A change has an effect, but not the right one; `how` in words that this exercise's mistakes know."""
    return Symptom.CHANGE_IGNORED.seen(trace, parameter=parameter, how=how, **about)


def judge_runtime(seen: RuntimeChanges, retimed: RateChanges) -> Verdict:
    """Judge `runtime-params`."""
    verdict = judge_changes(seen)
    # If a timer is left running whenever a parameter is set, it is up to `timer` to report that.
    if not verdict.passed or not judge_timer(retimed).passed:
        return verdict
    if seen.sent_after_rate:
        return failed(
            EXPECTED_CHANGES,
            f"{ENABLED} set to false, then {RATE} to {UP_HZ}: {counted(len(seen.sent_after_rate), 'message')}",
            _changed(seen.trace, RATE, "restarts"),
            [text_of(sample) for sample in seen.sent_after_rate[:3]],
        )
    return _fail_if_not_as_before(seen, EXPECTED_CHANGES, any_rate=False) or verdict


def _fail_if_not_as_before(seen: RuntimeChanges, expected: str, *, any_rate: bool) -> Verdict | None:
    """Fail if the messages after `enabled` is true again have the wrong prefix, or, unless `any_rate`, the wrong rate.

    The right prefix is the one that was set in the meantime.
    """
    actions = f"{PREFIX} set to {seen.later} while {ENABLED} was false, then {ENABLED} to true"
    texts = [text_of(sample) for sample in seen.after_resume]
    without = next((text for text in texts if seen.later not in text), None)
    if without is not None:
        return failed(
            expected, f'{actions}: "{without}"', Symptom.CHANGE_IGNORED.seen(seen.trace, parameter=PREFIX), texts
        )
    with_both = next((text for text in texts if seen.prefix in text), None)
    if with_both is not None:
        return failed(expected, f'{actions}: "{with_both}"', _changed(seen.trace, PREFIX, "adds"), texts)
    if texts and any_rate:
        return None
    burst = _burst_on_resume(seen)
    if len(burst) >= MIN_BURST:
        held = _changed(seen.trace, ENABLED, "held back")
        return failed(expected, f"{actions}: {len(burst)} messages at once", held, burst)
    if rate_is_unchanged(seen.rate, seen.base_hz, seen):
        return None
    observed = f"{actions}: {describe(seen.rate, len(texts))}, not {seen.base_hz:g} Hz ±{TOLERANCE:.0%} as before"
    if not texts:
        return failed(expected, observed, _changed(seen.trace, ENABLED, "does not resume"))
    changed = _changed(seen.trace, ENABLED, "rate changed", rate=seen.rate, wanted_hz=seen.base_hz)
    return failed(expected, observed, changed)


def _burst_on_resume(seen: RuntimeChanges) -> list[str]:
    """The messages within half a period of the first one after `enabled` was set to true again."""
    assert seen.resumed is not None
    begin = seen.resumed.source_time
    hz = max(seen.base_hz, seen.before.hz if seen.before else 0.0)
    return [text_of(s) for s in seen.trace.samples_on(TOPIC) if begin <= s.source_time < begin + 0.5 / hz]


def _last_text(trace: Trace) -> str:
    samples = trace.samples_on(TOPIC)
    return text_of(samples[-1]) if samples else "nothing"


def judge_timer(seen: RateChanges) -> Verdict:
    """Judge `timer`."""
    expected = f"setting {RATE} changes the measured rate: {UP_HZ} Hz, then {DOWN_HZ} Hz, ±{TOLERANCE:.0%}"
    if not seen.steps:
        return fail_not_running(seen, expected)
    for answer, rate, messages in seen.steps:
        asked = answer.values[RATE]
        if not answer.answered or not answer.successful:
            return fail_not_set(expected, answer, seen.trace, seen.stuck)
        if rate is None or not rate.agrees_with(asked):
            observed = f"{RATE} set to {asked}: {describe(rate, messages)}"
            return failed(expected, observed, _wrong_rate(seen, asked, rate))
    return passed(expected, ", then ".join(str(rate) for _, rate, _ in seen.steps))


def _wrong_rate(seen: RateChanges, asked: float, rate: Rate | None) -> Observation:
    before = DEFAULT_HZ if asked == UP_HZ else UP_HZ
    faster = seen.steps[0][1]
    left_behind = asked == DOWN_HZ and faster is not None and faster.hz > UP_HZ + DEFAULT_HZ / 2
    as_before = rate is not None and rate.agrees_with(before) and not left_behind
    followed = asked == DOWN_HZ and faster is not None and faster.agrees_with(UP_HZ)
    same = rate is not None and rate.hz < UP_HZ and all(are_alike(rate, other) for _, other, _ in seen.steps)
    return Symptom.WRONG_RATE.seen(
        seen.trace,
        parameter=RATE,
        wanted_hz=asked,
        rate=rate,
        unchanged=as_before or same,
        inverted=rate is None or rate.agrees_with(1 / asked),
        at_start=False,
        followed_hz=UP_HZ if followed else None,
        earlier_hz=(DEFAULT_HZ,) if asked == UP_HZ else (DEFAULT_HZ, UP_HZ),
    )
