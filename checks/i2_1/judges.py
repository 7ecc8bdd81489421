"""I2.1: the verdicts on starts of the node, with and without parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from checks.i2_1 import steps
from checks.i2_1.facts import (
    DEFAULT_HZ,
    DEFAULTS,
    ENABLED,
    LAUNCH_HZ,
    PREFIX,
    RATE,
    SLOW_LAUNCH_HZ,
    TOPIC,
    TYPE,
    ParameterStarts,
    PlainStart,
    messages_naming_rate,
    text_of,
)
from checks.i2_1.failures import (
    are_alike,
    diagnose_no_answer,
    diagnose_rounded_rate,
    show,
    with_steps,
)
from checks.i2_1.program import whole_program
from tutor.judge import causes, ending, tracebacks
from tutor.judge.causes import callback_slips, names, parameter_slips, period_slips, slips, spinning
from tutor.judge.rates import TOLERANCE, describe
from tutor.judge.rewriting.node import find_in_files, started_node
from tutor.judge.trace import Level, Trace
from tutor.judge.verdict import Cause, Verdict, failed, passed
from tutor.judge.wording import counted, shape
from tutor.ros_model import Parameter


@with_steps
def judge_defaults(seen: PlainStart) -> Verdict:
    expected = ", ".join(f"{name} = {show(value)} ({kind})" for name, (kind, value) in DEFAULTS.items())
    if seen.parameters is None:
        cause = diagnose_no_answer(seen.trace, seen.stuck)
        return failed(expected, "the node answers no parameter call", cause, causes.output_tail(seen.trace))
    found = {name: seen.value_of(name) for name in DEFAULTS}
    observed = ", ".join(f"{n} = {show(p.value)} ({p.type})" if p else f"no {n}" for n, p in found.items())
    wrong = [name for name, (kind, value) in DEFAULTS.items() if not _matches(found[name], kind, value)]
    if wrong:
        cause = _diagnose_default(wrong[0], found[wrong[0]], steps.declare_parameters(seen.trace, wrong))
        return failed(expected, observed, cause)
    return passed(expected, observed)


def judge_defaults_so_far(seen: PlainStart) -> Verdict | None:
    """Judge `defaults` as soon as the node has reported its parameters."""
    return judge_defaults(seen) if seen.parameters is not None else None


def _matches(parameter: Parameter | None, kind: str, value: Any) -> bool:
    return parameter is not None and (parameter.type, parameter.value) == (kind, value)


def _diagnose_default(name: str, parameter: Parameter | None, step: str) -> Cause:
    kind, value = DEFAULTS[name]
    if parameter is None:
        return Cause("parameter not declared", f"the node has no parameter {name}", step)
    if parameter.type != kind:
        is_integer = (kind, parameter.type) == ("double", "integer")
        text = f"{name} is of type {parameter.type}, not {kind}: the type of the default is the type of the parameter"
        return Cause(names.INTEGER_PARAMETER if is_integer else "wrong parameter type", text, step)
    return Cause("wrong default", f"{name} is {show(parameter.value)}, not {show(value)}", step)


@with_steps
def judge_launch(seen: ParameterStarts) -> Verdict:
    expected = f"--ros-args -p sets {PREFIX}, {RATE} and {ENABLED}, and each takes effect"
    samples = seen.trace.samples_on(TOPIC)
    given = f"{PREFIX}:={seen.prefix} {RATE}:={LAUNCH_HZ}"
    if not samples:
        cause = causes.diagnose_no_messages(seen.trace, TOPIC, TYPE, answers=True, step=steps.add_publisher(seen.trace))
        return failed(expected, f"with {given}: no message on {TOPIC}", cause, causes.output_tail(seen.trace))
    without = [text_of(sample) for sample in samples[-2:] if seen.prefix not in text_of(sample)]
    if without:
        ignored = [RATE] if seen.rate is None or not seen.rate.agrees_with(LAUNCH_HZ) else []
        ignored += [ENABLED] if seen.disabled.samples_on(TOPIC) else []
        return failed(
            expected,
            f'with {given}: "{without[-1]}"',
            _diagnose_ignored(PREFIX, seen.trace, *ignored),
            [text_of(s) for s in samples[:6]],
        )
    if seen.rate is None or not seen.rate.agrees_with(LAUNCH_HZ):
        observed = f"with {given}: {describe(seen.rate, seen.messages)}, not {LAUNCH_HZ} Hz ±{TOLERANCE:.0%}"
        return failed(expected, observed, causes.diagnose_same_name(seen.trace) or _diagnose_launch_rate(seen))
    if seen.slow_rate is None or not seen.slow_rate.agrees_with(SLOW_LAUNCH_HZ):
        slow = f"{RATE}:={SLOW_LAUNCH_HZ}: {describe(seen.slow_rate, seen.slow_messages)}"
        cause = (
            causes.diagnose_process(seen.slow)
            or diagnose_rounded_rate(seen.slow_rate, SLOW_LAUNCH_HZ, steps.use_parameter(seen.slow, RATE))
            or _diagnose_other_rate(seen.slow)
        )
        return failed(expected, f"with {slow}, not {SLOW_LAUNCH_HZ} Hz ±{TOLERANCE:.0%}", cause)
    off = f"with {ENABLED}:=false {RATE}:={LAUNCH_HZ}"
    loud = seen.disabled.samples_on(TOPIC)
    if loud:
        return failed(
            expected,
            f"{off}: {counted(len(loud), 'message')}",
            _diagnose_ignored(ENABLED, seen.disabled),
            [text_of(s) for s in loud[:3]],
        )
    broken = causes.diagnose_process(seen.disabled)
    held = seen.disabled_answer.value if seen.disabled_answer else None
    offered = any(p.topic == TOPIC for p in seen.disabled.graph.publishers)
    # A silent node with a publisher is disabled even if it answers no parameter call; one without a publisher must also
    # send messages once it is enabled.
    silent_on_purpose = held in (False, None) if offered else held is False and seen.first_after_enable is not None
    if broken or not silent_on_purpose:
        return failed(
            expected,
            f"{off}: silence, but not because {ENABLED} is false",
            broken or _diagnose_ignored(ENABLED, seen.disabled),
            causes.output_tail(seen.disabled),
        )
    return passed(
        expected,
        f'with {given}: "{text_of(samples[-1])}" at {seen.rate}; {off}: silence for {seen.disabled_for_s:.1f} s',
    )


def _diagnose_launch_rate(seen: ParameterStarts) -> Cause:
    rate, trace = seen.rate, seen.trace
    period_slip = find_in_files(
        trace, slips.diagnose_xor, period_slips.diagnose_second_timer, period_slips.diagnose_integer_period
    )
    if period_slip is not None:
        return period_slip
    if rate is not None and rate.in_bursts:
        return causes.diagnose_bursts(trace, steps.send_once_per_tick(trace))
    if (waits := find_in_files(trace, spinning.diagnose_untimed_spin_once)) is not None:
        return waits
    read = started_node(trace)
    if rate is not None and (rate.agrees_with(DEFAULT_HZ) or are_alike(rate, seen.slow_rate)):
        # A sleep that takes at least half of the period explains it; a shorter one does not.
        asleep = period_slips.diagnose_sleep(read, 0.2 * rate.hz) if read.timers else None
        return asleep or _diagnose_ignored(RATE, trace)
    if rate is None and (loop := callback_slips.diagnose_loop_in_callback(read, whole_program(read))) is not None:
        return loop
    if rate is None or rate.agrees_with(1 / LAUNCH_HZ):
        return causes.diagnose_rate_as_period(RATE, steps.use_parameter(trace, RATE))
    return _diagnose_other_rate(trace)


def _diagnose_other_rate(trace: Trace) -> Cause:
    return find_in_files(
        trace,
        period_slips.diagnose_integer_period,
        lambda file: period_slips.diagnose_sleep(file, LAUNCH_HZ),
        period_slips.diagnose_throttle,
    ) or Cause("wrong rate", f"{RATE} has an effect, but not this one", steps.use_parameter(trace, RATE))


def _diagnose_ignored(name: str, trace: Trace, *others: str) -> Cause:
    return (
        find_in_files(trace, parameter_slips.diagnose_dropped_arguments)
        or steps.diagnose_override(trace, name)
        or Cause(
            "parameter ignored",
            f"{name} given at start-up has no effect",
            steps.use_parameter(trace, name, *others),
        )
    )


@with_steps
def judge_bad_launch(plain: PlainStart, seen: Sequence[Trace]) -> Verdict:
    expected = f"a start with {RATE}:=0.0 or {RATE}:=-1.0 gives a message that names {RATE}"
    ordinary = {_wording(line) for line in messages_naming_rate(plain.trace)}
    for trace in seen:
        if not any(_wording(line) not in ordinary for line in messages_naming_rate(trace)):
            given = f"{RATE}:={trace.parameters[RATE]}"
            found = tracebacks.last_traceback(trace)
            warning = next((str(log) for log in reversed(trace.logs) if log.level >= Level.WARN), "")
            if warning and not found:
                cause = Cause(
                    "parameter not named",
                    f"the message does not name {RATE}, which is what was typed",
                    f"put {RATE} into the message",
                )
                return failed(expected, f"with {given}: {warning}", cause)
            observed = f"with {given}: {found.raised if found else 'no message about it'}"
            cause = Cause(
                "only a traceback" if found else "no validation",
                "nobody can tell from this which parameter is wrong"
                if found
                else "the node takes the bad value silently",
                steps.check_at_start(trace),
            )
            return failed(expected, observed, cause, causes.output_tail(trace))
    return passed(expected, "it does", [messages_naming_rate(trace)[-1] for trace in seen])


def _wording(line: str) -> str:
    """Strip a line of numbers and its log prefix, so that it can be compared with those of an ordinary start."""
    return shape(line.rsplit("]: ", 1)[-1])


def judge_shutdown(seen: PlainStart) -> Verdict:
    return ending.judge_ending(seen.trace, seen.ending)
