"""I2.1: the verdicts on parameters that are set while the node runs."""

from __future__ import annotations

from dataclasses import replace

from checks.i2_1 import steps
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
    diagnose_rounded_rate,
    fail_not_running,
    fail_not_set,
    rate_is_unchanged,
    with_steps,
)
from checks.i2_1.program import whole_program
from tutor.judge import causes
from tutor.judge.causes import (
    callback_slips,
    names,
    parameter_callback_slips,
    parameter_slips,
    period_slips,
    slips,
    spinning,
)
from tutor.judge.causes.inheritance import diagnose_timer_of_base_class
from tutor.judge.rates import TOLERANCE, Rate, describe
from tutor.judge.rewriting.node import find_in_files, started_node
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause, Verdict, failed, passed
from tutor.judge.wording import counted

EXPECTED_CHANGES = f"setting {PREFIX} and {ENABLED} on the running node takes effect within one period"


@with_steps
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
            _diagnose_ignored_change(PREFIX, seen.trace),
        )
    if seen.sent_while_off:
        return failed(
            expected,
            f"{ENABLED} set to false, but {counted(len(seen.sent_while_off), 'message')} more than a period later",
            _diagnose_ignored_change(ENABLED, seen.trace),
            [text_of(s) for s in seen.sent_while_off[:3]],
        )
    if seen.resumed is None:
        cause = causes.diagnose_process(seen.trace) if seen.trace.exit else None
        return failed(
            expected,
            f"{ENABLED} set to false and to true again: no message since",
            cause
            or find_in_files(seen.trace, spinning.diagnose_untimed_spin_once)
            or Cause(
                "does not resume",
                f"{ENABLED} true does not bring the messages back",
                slips.fix_bool_compared_with_text(seen.trace) or steps.keep_timer_running(seen.trace),
            ),
        )
    assert seen.set_on is not None
    return _fail_if_not_as_before(seen, expected, any_rate=True) or passed(
        expected,
        f'"{text_of(seen.after_prefix)}"; silence while false; resumed '
        f"{seen.resumed.source_time - seen.set_on.asked_at:.2f} s after true",
    )


def _fail_silenced(seen: RuntimeChanges) -> Verdict:
    """Fail a node that sends nothing more once `enabled` is set to true, which it was already."""
    observed = f"{PREFIX} set to {seen.prefix}, and {ENABLED} to true, which it was already: no message since"
    if seen.inverts:
        cause = Cause(
            "value inverted",
            f"{ENABLED} set to true stops the messages, and set to true once more, it brings them back",
            f"use the value that {ENABLED} is set to, not the opposite of the one before",
        )
    else:
        cause = causes.diagnose_process(seen.trace) or Cause(
            "messages stop",
            f"neither a new {PREFIX} nor an {ENABLED} that stays true is a reason to stop",
            steps.keep_timer_running(seen.trace),
        )
    return failed(EXPECTED_CHANGES, observed, cause, causes.output_tail(seen.trace))


@with_steps
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
            Cause(
                "restarted by another parameter",
                f"setting {RATE} starts the messages again, though {ENABLED} is still false",
                steps.keep_timer_running(seen.trace),
            ),
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
        return failed(expected, f'{actions}: "{without}"', _diagnose_ignored_change(PREFIX, seen.trace), texts)
    with_both = next((text for text in texts if seen.prefix in text), None)
    if with_both is not None:
        cause = Cause(
            "old prefix kept", "the new prefix does not replace the old one", steps.use_parameter(seen.trace, PREFIX)
        )
        return failed(expected, f'{actions}: "{with_both}"', cause, texts)
    if texts and any_rate:
        return None
    burst = _burst_on_resume(seen)
    if len(burst) >= MIN_BURST:
        cause = Cause(
            "messages held back",
            f"messages due while {ENABLED} is false are queued, and sent when it is true again",
            steps.send_once_per_tick(seen.trace),
        )
        return failed(expected, f"{actions}: {len(burst)} messages at once", cause, burst)
    if rate_is_unchanged(seen.rate, seen.base_hz, seen):
        return None
    observed = f"{actions}: {describe(seen.rate, len(texts))}, not {seen.base_hz:g} Hz ±{TOLERANCE:.0%} as before"
    return failed(
        expected,
        observed,
        (causes.diagnose_process(seen.trace) if seen.trace.exit else None)
        or find_in_files(seen.trace, spinning.diagnose_untimed_spin_once)
        or Cause(
            "rate changed",
            f"the rate is different after setting {PREFIX} and {ENABLED}, though {RATE} was not touched",
            steps.keep_timer_running(seen.trace),
        ),
    )


def _burst_on_resume(seen: RuntimeChanges) -> list[str]:
    """The messages within half a period of the first one after `enabled` was set to true again."""
    assert seen.resumed is not None
    begin = seen.resumed.source_time
    hz = max(seen.base_hz, seen.before.hz if seen.before else 0.0)
    return [text_of(s) for s in seen.trace.samples_on(TOPIC) if begin <= s.source_time < begin + 0.5 / hz]


def _diagnose_ignored_change(name: str, trace: Trace) -> Cause:
    compared = slips.fix_bool_compared_with_text(trace) if name == ENABLED else None
    if compared is not None:
        return Cause("parameter ignored", f"{name} is accepted, but compared with a text", compared)
    override = find_in_files(trace, lambda file: parameter_slips.diagnose_override(file, name))
    if (cause := override or parameter_callback_slips.diagnose_broken_callback(trace)) is not None:
        return cause
    old = find_in_files(trace, lambda file: parameter_callback_slips.diagnose_old_value_read(file, name))
    if old is not None:
        return replace(old, hint=old.hint or steps.use_parameter_later(trace, name))
    text = f"{name} is accepted, but what the node sends does not follow it"
    return Cause("parameter ignored", text, steps.use_parameter_later(trace, name))


def _last_text(trace: Trace) -> str:
    samples = trace.samples_on(TOPIC)
    return text_of(samples[-1]) if samples else "nothing"


@with_steps
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
            return failed(
                expected,
                f"{RATE} set to {asked}: {describe(rate, messages)}",
                causes.diagnose_same_name(seen.trace) or _diagnose_timer(seen, asked, rate),
            )
    return passed(expected, ", then ".join(str(rate) for _, rate, _ in seen.steps))


def _diagnose_timer(seen: RateChanges, asked: float, rate: Rate | None) -> Cause:
    if seen.trace.exit and (cause := causes.diagnose_process(seen.trace)):
        return cause
    read, trace = started_node(seen.trace), seen.trace
    waits = find_in_files(trace, spinning.diagnose_untimed_spin_once)
    if waits is not None and (rate is None or rate.hz < asked):
        return waits
    period_slip = find_in_files(
        trace,
        slips.diagnose_xor,
        period_slips.diagnose_second_timer,
        period_slips.diagnose_integer_period,
        period_slips.diagnose_nanoseconds,
        period_slips.diagnose_period_attribute,
    )
    if rate is not None and rate.in_bursts:
        return period_slip or causes.diagnose_bursts(trace, steps.send_once_per_tick(trace))
    if rate is not None and rate.hz < asked:
        slow = find_in_files(
            trace,
            lambda file: period_slips.diagnose_sleep(file, asked),
            period_slips.diagnose_throttle,
            spinning.diagnose_nap_between_spins,
        )
        if slow is not None:
            return slow
    before = DEFAULT_HZ if asked == UP_HZ else UP_HZ
    faster = seen.steps[0][1]
    left_behind = asked == DOWN_HZ and faster is not None and faster.hz > UP_HZ + DEFAULT_HZ / 2
    if rate is not None and rate.agrees_with(before) and not left_behind:
        return _diagnose_old_period(trace)
    if rate is not None and rate.hz < UP_HZ and all(are_alike(rate, other) for _, other, _ in seen.steps):
        return _diagnose_old_period(trace)
    if (rounded := diagnose_rounded_rate(rate, asked, steps.follow_changes(trace))) is not None:
        return rounded
    if rate is not None and rate.hz > asked:
        left = period_slip or diagnose_timer_of_base_class(trace)
        return left or causes.diagnose_old_timer(rate.hz, asked, steps.cancel_old_timer(trace))
    if rate is None and (loop := callback_slips.diagnose_loop_in_callback(read, whole_program(read))) is not None:
        return loop
    if rate is None or rate.agrees_with(1 / asked):
        return period_slip or causes.diagnose_rate_as_period(RATE, steps.follow_changes(trace))
    return Cause("wrong rate", f"{rate.hz:.1f} Hz instead of {asked:g} Hz", steps.follow_changes(trace))


def _diagnose_old_period(trace: Trace) -> Cause:
    """Diagnose a timer that keeps its old period although the parameter has a new value."""
    if (cause := find_in_files(trace, lambda file: parameter_slips.diagnose_override(file, RATE))) is not None:
        return cause
    old = find_in_files(trace, lambda file: parameter_callback_slips.diagnose_old_value_read(file, RATE))
    if old is not None:
        return replace(old, hint=old.hint or steps.follow_changes(trace))
    text = "the parameter changes, but the timer keeps its old period"
    return parameter_callback_slips.diagnose_broken_callback(trace) or Cause(
        names.TIMER_NOT_REPLACED, text, steps.follow_changes(trace)
    )
