"""I2.1: the verdicts on bad rates that are set while the node runs."""

from __future__ import annotations

from checks.i2_1.facts import (
    PREFIX,
    RATE,
    AtomicRequests,
    BadRates,
    RateChanges,
    RuntimeChanges,
    text_of,
)
from checks.i2_1.failures import (
    describe_refusal,
    fail_not_running,
    fail_not_set,
    rate_is_unchanged,
    show,
)
from tutor.judge import tracebacks
from tutor.judge.parameter_answers import is_from_rclpy
from tutor.judge.rates import Rate, describe
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import SetAnswer, Trace
from tutor.judge.verdict import Verdict, failed, passed, skipped
from tutor.judge.wording import output_tail


def judge_validation(seen: BadRates, switched: RuntimeChanges) -> Verdict:
    """Judge `validation`."""
    expected = _expected_refusal(seen)
    if not seen.rejected:
        return fail_not_running(seen, expected)
    if (accepted := _fail_if_not_refused(seen, expected)) is not None:
        return accepted
    if seen.set_good is not None:
        return skipped(f"not judged, because {describe_refusal(seen.set_good)}: see `timer`")
    if not rate_is_unchanged(seen.rate, seen.base_hz, switched, seen.rate_before):
        observed = f"after the rejection: {describe(seen.rate, seen.messages)}"
        return failed(expected, observed, _rate_changed(seen.trace, seen.rate))
    return passed(expected, f'rejected: "{seen.rejected[0][0].reason}"; still {seen.rate}')


def judge_validation_so_far(seen: BadRates) -> Verdict:
    """Judge `validation` by the answers so far."""
    expected = _expected_refusal(seen)
    return _fail_if_not_refused(seen, expected) or passed(expected, "so far")


def _expected_refusal(seen: BadRates) -> str:
    return f"{RATE} 0.0 and -1.0 are rejected with a reason; the value and the rate stay at {seen.base_hz} Hz"


def _fail_if_not_refused(seen: BadRates, expected: str) -> Verdict | None:
    """Fail if one of the answers to bad rates is wrong."""
    for answer, value in seen.rejected:
        bad = answer.values[RATE]
        if not answer.answered:
            return _fail_if_crashed(answer, expected, seen.trace) or fail_not_set(
                expected, answer, seen.trace, seen.stuck
            )
        if answer.successful:
            return failed(expected, f"{RATE} {bad} was accepted", _accepted(seen.trace, answer))
        if not answer.reason.strip():
            mute = Symptom.BAD_VALUE_ACCEPTED.seen(seen.trace, parameter=RATE, answer=answer, reason="")
            return failed(expected, f"{bad} was rejected without a reason", mute)
        if is_from_rclpy(answer.reason):
            return fail_not_set(expected, answer, seen.trace, seen.stuck)
        if value != seen.before:
            observed = f"{bad} was rejected, but {RATE} is {show(value)} now"
            return failed(expected, observed, _taken_over(seen.trace, "the value changes"))
    return None


def _fail_if_crashed(answer: SetAnswer, expected: str, trace: Trace) -> Verdict | None:
    """Fail a node that crashed because it accepted a bad rate and created a timer from it."""
    found = tracebacks.last_traceback(trace)
    if found is None or trace.exit is None:
        return None
    if found.type != "ZeroDivisionError" and "timer period must be non-negative" not in found.message:
        return None
    observed = f"{RATE} set to {answer.values[RATE]} ends the node: {found.plain}"
    return failed(expected, observed, _accepted(trace, answer), output_tail(trace))


def _accepted(trace: Trace, answer: SetAnswer) -> Observation:
    return Symptom.BAD_VALUE_ACCEPTED.seen(trace, parameter=RATE, value=answer.values[RATE], answer=answer)


def _taken_over(trace: Trace, what: str) -> Observation:
    """A value was rejected, and something has changed all the same."""
    return Symptom.BAD_VALUE_ACCEPTED.seen(trace, parameter=RATE, taken_over=what)


def _rate_changed(trace: Trace, rate: Rate | None) -> Observation:
    """A value was rejected, and messages come at another rate, or no more."""
    if trace.exit is not None:
        return Symptom.ENDED.seen(trace)
    return _taken_over(trace, "the rate changes" if rate is not None else "the messages stop")


def judge_atomic(seen: AtomicRequests, switched: RuntimeChanges, retimed: RateChanges) -> Verdict:
    """Judge `atomic`."""
    expected = f"an atomic set of a good {PREFIX} and a bad {RATE}, in either order, changes nothing at all"
    if not seen.answers:
        return fail_not_running(seen, expected)
    if seen.set_good is not None and seen.set_good.answered and not seen.set_good.successful:
        why = describe_refusal(seen.set_good)
        set_rate = retimed.steps[0][0] if retimed.steps else None
        each = (("runtime-params", switched.set_prefix), ("timer", set_rate))
        alone = [name for name, answer in each if answer is not None and not answer.successful]
        return skipped(f"not judged, because {why}{f': see `{alone[0]}`' if alone else ''}")
    unanswered = next((answer for answer in seen.answers if not answer.answered), None)
    if unanswered is not None:
        return _fail_if_crashed(unanswered, expected, seen.trace) or fail_not_set(
            expected, unanswered, seen.trace, seen.stuck
        )
    if any(answer.successful for answer in seen.answers):
        accepted = next(answer for answer in seen.answers if answer.successful)
        return failed(expected, "the request was accepted", _accepted(seen.trace, accepted))
    changed = next((held for held in seen.values if held != seen.before), None)
    if changed is not None or seen.shown is not None:
        now = f'a message reads "{text_of(seen.shown)}"' if seen.shown else f"{PREFIX}, {RATE} are {changed}"
        return failed(expected, f"rejected, but {now}", _taken_over(seen.trace, "applies a part of the request"))
    if not rate_is_unchanged(seen.rate, seen.base_hz, switched):
        observed = f"rejected, but then {describe(seen.rate, seen.messages)}"
        return failed(expected, observed, _rate_changed(seen.trace, seen.rate))
    return passed(expected, f'both rejected ("{seen.answers[0].reason}"), nothing changed')
