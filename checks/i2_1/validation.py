"""I2.1: the verdicts on bad rates that are set while the node runs."""

from __future__ import annotations

from checks.i2_1 import steps
from checks.i2_1.facts import (
    BAD_RATES,
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
    with_steps,
)
from tutor.judge import causes, tracebacks
from tutor.judge.causes import parameter_callback_slips, period_slips, spinning
from tutor.judge.rates import describe
from tutor.judge.rewriting.node import find_in_files, started_node
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause, Verdict, failed, passed, skipped


@with_steps
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
        cause = causes.diagnose_process(seen.trace) if seen.trace.exit else None
        cause = cause or _diagnose_change(seen.trace, "the rate changes although the value was rejected")
        return failed(expected, f"after the rejection: {describe(seen.rate, seen.messages)}", cause)
    return passed(expected, f'rejected: "{seen.rejected[0][0].reason}"; still {seen.rate}')


@with_steps
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
            return _fail_if_crashed(bad, expected, seen.trace) or fail_not_set(expected, answer, seen.trace, seen.stuck)
        if answer.successful:
            return failed(
                expected,
                f"{RATE} {bad} was accepted",
                _diagnose_no_validation(seen.trace, bad),
            )
        if not answer.reason.strip():
            return failed(
                expected,
                f"{bad} was rejected without a reason",
                Cause("no reason given", "the reason is empty", steps.refuse_bad_rates(seen.trace)),
            )
        if causes.RCLPY_REASON.match(answer.reason):
            return fail_not_set(expected, answer, seen.trace, seen.stuck)
        if value != seen.before:
            return failed(
                expected,
                f"{bad} was rejected, but {RATE} is {show(value)} now",
                _diagnose_change(seen.trace, "the value is not what it was"),
            )
    return None


def _fail_if_crashed(bad: float, expected: str, trace: Trace) -> Verdict | None:
    """Fail a node that crashed because it accepted a bad rate and created a timer from it."""
    found = tracebacks.last_traceback(trace)
    raised = found.raised if found is not None and trace.exit is not None else ""
    if not raised.startswith("ZeroDivisionError") and "timer period must be non-negative" not in raised:
        return None
    cause = _diagnose_no_validation(trace, bad)
    return failed(expected, f"{RATE} set to {bad} ends the node: {raised}", cause, causes.output_tail(trace))


def _diagnose_change(trace: Trace, text: str) -> Cause:
    slip = find_in_files(
        trace,
        period_slips.diagnose_second_timer,
        parameter_callback_slips.diagnose_callback_order,
        spinning.diagnose_untimed_spin_once,
    )
    return slip or Cause("value changed all the same", text, steps.refuse_bad_rates(trace))


def _diagnose_no_validation(trace: Trace, bad: float) -> Cause:
    """Diagnose a node that accepts a bad rate."""
    read = started_node(trace)
    return parameter_callback_slips.diagnose_broken_callback(trace) or Cause(
        "no validation", parameter_callback_slips.why_accepted(read, bad), steps.refuse_bad_rates(trace)
    )


@with_steps
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
        return _fail_if_crashed(BAD_RATES[1], expected, seen.trace) or fail_not_set(
            expected, unanswered, seen.trace, seen.stuck
        )
    if any(answer.successful for answer in seen.answers):
        return failed(
            expected,
            "the request was accepted",
            _diagnose_no_validation(seen.trace, BAD_RATES[1]),
        )
    changed = next((held for held in seen.values if held != seen.before), None)
    partial = steps.check_all_first(seen.trace)
    if changed is not None or seen.shown is not None:
        now = f'a message reads "{text_of(seen.shown)}"' if seen.shown else f"{PREFIX}, {RATE} are {changed}"
        return failed(
            expected,
            f"rejected, but {now}",
            find_in_files(seen.trace, parameter_callback_slips.diagnose_callback_order)
            or Cause(
                "partial change", "the callback applies the first parameter before it looks at the second", partial
            ),
        )
    if not rate_is_unchanged(seen.rate, seen.base_hz, switched):
        return failed(
            expected,
            f"rejected, but then {describe(seen.rate, seen.messages)}",
            find_in_files(seen.trace, period_slips.diagnose_second_timer, spinning.diagnose_untimed_spin_once)
            or Cause("partial change", "the timer was touched although the request was rejected", partial),
        )
    return passed(expected, f'both rejected ("{seen.answers[0].reason}"), nothing changed')
