"""I1.1: why a criterion fails, as pure functions of the facts."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from functools import partial

from checks.i1_1 import steps
from checks.i1_1.facts import (
    SUGGESTED_NAME,
    SUGGESTED_RATE,
    TOPIC,
    TYPE,
    NameProbes,
    RateProbe,
    are_inverted,
)
from tutor.judge import causes, tracebacks
from tutor.judge.causes import callback_slips
from tutor.judge.rates import TOLERANCE
from tutor.judge.rewriting.node import find_in_files
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause
from tutor.ros_model import Parameter


def diagnose_exception(trace: Trace | None) -> Cause | None:
    """Diagnose the exception that ended the node: it says more than the messages that went missing because of it."""
    return (
        causes.diagnose_process(trace) if trace is not None and tracebacks.last_traceback(trace) is not None else None
    )


def diagnose_stopped(trace: Trace | None) -> Cause:
    """Diagnose a node that publishes too little; an exception that ended it comes first."""
    step = steps.add_publisher(trace) or "publish from a timer's callback"
    text = "the node stops publishing, or publishes far too rarely"
    return diagnose_exception(trace) or Cause("no messages", text, step)


def is_fahrenheit(value: float) -> bool:
    """Whether a value is what a room has in degrees Fahrenheit: 60 to 90."""
    return 60 <= value <= 90


def diagnose_range(wrong: Sequence[float], values: Sequence[float], trace: Trace | None) -> Cause:
    """Diagnose values that are out of range, such as degrees Fahrenheit."""
    if all(math.isfinite(value) and 0 < abs(value) < 1e-300 for value in wrong):
        return Cause(
            "an int in a float field",
            "Float64.data got a Python int, or an array: its bits are sent as if they were a float",
            steps.make_float(trace),
        )
    if all(map(is_fahrenheit, values)):
        return Cause("out of range", "these look like degrees Fahrenheit", steps.draw_values(trace))
    if len(set(wrong)) == 1 and trace is not None:
        initial = find_in_files(trace, partial(steps.diagnose_initial_value, value=wrong[0]))
        if initial is not None:
            return initial
    return Cause("out of range", "values leave the range", steps.draw_values(trace))


def diagnose_undeclared_rate(trace: Trace | None) -> Cause:
    """Diagnose a rate that is no parameter."""
    step = steps.declare_rate(trace, SUGGESTED_RATE)
    return Cause("parameter not declared", "the rate cannot be set from outside", step)


def diagnose_rate(group: Sequence[RateProbe], wrong: RateProbe, declared: tuple[Parameter, ...] | None) -> Cause:
    """Diagnose a rate that differs from the one asked for; `group`: the probes that agree with each other best."""
    if (truncated := steps.diagnose_whole_rate(wrong.trace, wrong.name)) is not None:
        return truncated
    broken = causes.diagnose_process(wrong.trace)
    if broken is not None:
        return broken
    if declared is not None and wrong.name not in {parameter.name for parameter in declared}:
        return diagnose_undeclared_rate(wrong.trace)
    step = steps.set_timer_period(wrong.trace, wrong.name, wrong.unit)
    if wrong.rate is not None and wrong.rate.in_bursts:
        return causes.diagnose_bursts(wrong.trace, step)
    measured = [(probe, probe.rate) for probe in group if probe.rate is not None]
    if are_inverted(group):
        if wrong.unit == "Hz":
            return causes.diagnose_rate_as_period(wrong.name, step)
        return causes.diagnose_period_as_rate(wrong.name, step)
    rates_hz = [rate.hz for _, rate in measured]
    if (
        cause := causes.diagnose_same_name(wrong.trace) or steps.diagnose_rate(wrong.trace, wrong.name, wrong.asked_hz)
    ) is not None:
        return cause
    if len(rates_hz) > 1 and max(rates_hz) <= min(rates_hz) * (1 + TOLERANCE):
        return Cause("parameter ignored", f"the rate stays at {rates_hz[0]:.1f} Hz, whatever {wrong.name} says", step)
    unused = find_in_files(wrong.trace, callback_slips.diagnose_unused_group)
    return unused or Cause("wrong rate", f"{wrong}", step)


def diagnose_name(found: NameProbes) -> Cause:
    """Diagnose a name that no log message contains."""
    for probe in found.probes:
        broken = causes.diagnose_process(probe.trace) or causes.diagnose_lifecycle(probe.trace)
        if broken is not None:
            return broken
        contains_value = re.compile(re.escape(probe.value)).search
        printed = causes.diagnose_printed(probe.trace, contains_value, "the name", after=probe.at_end)
        if printed is not None:
            return printed
    if found.declared is None:
        return Cause(
            "parameter not declared",
            f"the node answers no parameter call, and {SUGGESTED_NAME} has no effect",
            steps.declare_name(found.probes[0].trace, SUGGESTED_NAME),
        )
    silent = next(
        (each.trace for each in found.probes if not each.trace.logs and not each.trace.samples_on(TOPIC)), None
    )
    if silent is not None and any(each.topic == TOPIC for each in silent.graph.publishers):
        return causes.diagnose_no_messages(silent, TOPIC, TYPE, answers=True, step=steps.add_publisher(silent))
    declared = [probe for probe in found.probes if probe.name in {parameter.name for parameter in found.declared}]
    return steps.diagnose_name(found.probes[0].trace, (declared or found.probes)[0].name)
