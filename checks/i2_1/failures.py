"""I2.1: failures that several criteria share, and what they have in common."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from checks.i2_1 import steps
from checks.i2_1.facts import (
    RATE,
    TOPIC,
    TYPE,
    VALIDATION_HZ,
    AtomicRequests,
    BadRates,
    RateChanges,
    RuntimeChanges,
)
from tutor.judge import causes
from tutor.judge.causes import names, parameter_slips
from tutor.judge.rates import Rate
from tutor.judge.rewriting import parameter_callbacks
from tutor.judge.rewriting.node import find_in_files, started_node
from tutor.judge.rewriting.whole import with_applicable_steps
from tutor.judge.trace import SetAnswer, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Cause, Verdict, failed


def _traces(*facts: object) -> list[Trace]:
    return [trace for each in facts if isinstance(trace := getattr(each, "trace", None), Trace)]


def with_steps[**P](judge: Callable[P, Verdict]) -> Callable[P, Verdict]:
    """Decorate a judge: the next step of its failures is an edit of the file if possible."""
    return with_applicable_steps(judge, _traces, steps.whole_program_step)


def fail_not_running(seen: RuntimeChanges | BadRates | RateChanges | AtomicRequests, expected: str) -> Verdict:
    """Fail a node that nothing can be asked of: it publishes nothing, or answers nothing."""
    trace, stuck = seen.trace, seen.stuck
    if trace.samples_on(TOPIC):
        return failed(
            expected,
            "the node answers no parameter call",
            diagnose_no_answer(trace, stuck),
            causes.output_tail(trace),
        )
    cause = causes.diagnose_no_messages(
        trace, TOPIC, TYPE, answers=seen.answering, stuck=stuck, step=steps.add_publisher(trace)
    )
    return failed(expected, f"no message on {TOPIC} to start with", cause, causes.output_tail(trace))


def fail_not_set(expected: str, answer: SetAnswer, trace: Trace, stuck: Sequence[Frame]) -> Verdict:
    """Fail a node that does not answer a parameter request, or rejects one that it should accept."""
    what = _describe_values(answer)
    if not answer.answered:
        cause = diagnose_no_answer(trace, stuck, spins=True)
        observed = f"setting {what}: {causes.describe_no_answer(trace, answer.took_s)}"
        return failed(expected, observed, cause, causes.output_tail(trace))
    cause = causes.diagnose_refusal(answer.reason, steps.accept_value(trace, answer))
    if cause.name == names.CALLBACK_RETURNS_NONE and parameter_callbacks.is_coroutine(started_node(trace)):
        text = "the parameter callback is an async def: rclpy does not await it, and so gets no SetParametersResult"
        cause = replace(cause, text=text)
    if "read-only" in answer.reason:
        cause = find_in_files(trace, parameter_slips.diagnose_read_only) or cause
    return failed(expected, f'setting {what}: rejected, "{answer.reason}"', cause)


def describe_refusal(answer: SetAnswer) -> str:
    """Say that good values were rejected, so that the rejection of bad ones shows nothing."""
    return f'the node rejects good values, too (setting {_describe_values(answer)}: "{answer.reason}")'


def _describe_values(answer: SetAnswer) -> str:
    return ", ".join(f"{name} to {show(value)}" for name, value in answer.values.items())


def diagnose_no_answer(trace: Trace, stuck: Sequence[Frame], *, spins: bool = False) -> Cause:
    """Diagnose a node that answers nothing; if a callback blocks, the step removes the wait."""
    cause = causes.diagnose_no_answer(trace, stuck, spins=spins)
    blocked = causes.diagnose_blocked(trace, stuck, spins=spins)
    return replace(cause, hint=steps.remove_waits(trace, stuck)) if cause == blocked else cause


def diagnose_rounded_rate(rate: Rate | None, asked: float, step: str) -> Cause | None:
    """Diagnose a rounded rate: 1.5 Hz that becomes 1 or 2 Hz, or 0.75 Hz that becomes 1 Hz."""
    rounded = {math.floor(asked), math.ceil(asked)} - {asked}
    if rate is None or not any(abs(rate.hz - hz) < 0.1 for hz in rounded):
        return None
    return Cause("rate made a whole number", f"{RATE} {asked} is treated as {rate.hz:.0f}", step)


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
