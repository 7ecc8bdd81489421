"""I2.1: failures that several criteria share, and what they have in common."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from checks.i2_1.facts import (
    TOPIC,
    TYPE,
    VALIDATION_HZ,
    AtomicRequests,
    BadRates,
    RateChanges,
    RuntimeChanges,
)
from tutor.judge.rates import Rate
from tutor.judge.symptom import Symptom
from tutor.judge.trace import SetAnswer, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Verdict, failed
from tutor.judge.wording import describe_no_answer, output_tail


def fail_not_running(seen: RuntimeChanges | BadRates | RateChanges | AtomicRequests, expected: str) -> Verdict:
    """Fail a node that nothing can be asked of: it publishes nothing, or answers nothing."""
    trace = seen.trace
    if trace.samples_on(TOPIC):
        silent = Symptom.NO_ANSWER.seen(trace, stuck=seen.stuck, answers=False)
        return failed(expected, "the node answers no parameter call", silent, output_tail(trace))
    missing = Symptom.NO_MESSAGES.seen(trace, stuck=seen.stuck, answers=seen.answering, topic=TOPIC, type=TYPE)
    return failed(expected, f"no message on {TOPIC} to start with", missing, output_tail(trace))


def fail_not_set(expected: str, answer: SetAnswer, trace: Trace, stuck: Sequence[Frame]) -> Verdict:
    """Fail a node that does not answer a parameter request, or rejects one that it should accept."""
    what, name = _describe_values(answer), next(iter(answer.values))
    if not answer.answered:
        silent = Symptom.NO_ANSWER.seen(trace, stuck=tuple(stuck), parameter=name)
        observed = f"setting {what}: {describe_no_answer(trace, answer.took_s)}"
        return failed(expected, observed, silent, output_tail(trace))
    refused = Symptom.REFUSED.seen(trace, parameter=name, value=answer.values[name], answer=answer)
    return failed(expected, f'setting {what}: rejected, "{answer.reason}"', refused)


def describe_refusal(answer: SetAnswer) -> str:
    """Say that good values were rejected, so that the rejection of bad ones shows nothing."""
    return f'the node rejects good values, too (setting {_describe_values(answer)}: "{answer.reason}")'


def _describe_values(answer: SetAnswer) -> str:
    return ", ".join(f"{name} to {show(value)}" for name, value in answer.values.items())


def are_alike(rate: Rate, other: Rate | None) -> bool:
    """Whether two rates are about the same, although different ones were requested."""
    return other is not None and max(rate.hz, other.hz) < 1.1 * min(rate.hz, other.hz)


def rate_is_unchanged(rate: Rate | None, hz: float, switched: RuntimeChanges, before: Rate | None = None) -> bool:
    """Whether the rate is still `hz`, or `before`, or the one the node has actually published at from the start."""
    if rate is None or rate.agrees_with(hz):
        return rate is not None
    if before is not None and rate.agrees_with(before.hz):
        return True  # the difference from `hz`, as by a timer that was left running, was there already
    # A node at VALIDATION_HZ has just been measured at exactly that rate, so the initial one is no excuse.
    return hz != VALIDATION_HZ and switched.before is not None and switched.before.agrees_with(rate.hz)


def show(value: Any) -> str:
    """A value as it is written on the command line."""
    return str(value).lower() if isinstance(value, bool) else repr(value) if isinstance(value, str) else str(value)
