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
    RatedStart,
    find_without_prefix,
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
from tutor.judge.verdict import Cause, Verdict, failed, passed, skipped
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
    """Judge `launch-params`."""
    failure = _judge_fast(seen) or _judge_slow(seen) or _judge_disabled(seen)
    if failure is not None:
        return failure
    assert seen.fast is not None
    assert seen.disabled is not None
    return passed(
        _EXPECTED_AT_LAUNCH,
        f'with {_given_fast(seen)}: "{text_of(seen.fast.trace.samples_on(TOPIC)[-1])}" at {seen.fast.rate}; '
        f"{_GIVEN_DISABLED}: silence for {seen.disabled.quiet_s:.1f} s",
    )


def judge_launch_so_far(seen: ParameterStarts) -> Verdict | None:
    """Judge `launch-params` by the fast start alone, if the others can change neither the verdict nor its cause.

    If that start ignores a parameter for no known reason, the others may be ignored, too: the next step is for all of
    them. Whether it ignores the rate, shows only in comparison with the slow start.
    """
    failure, start = _judge_fast(seen), seen.fast
    if failure is None or start is None or failure.cause.startswith(_IGNORED):
        return None
    samples = start.trace.samples_on(TOPIC)
    is_rate_wrong = bool(samples) and not find_without_prefix(samples, seen.prefix)
    return None if is_rate_wrong and _diagnose_fast_rate_alone(start) is None else judge_launch(seen)


_EXPECTED_AT_LAUNCH = f"--ros-args -p sets {PREFIX}, {RATE} and {ENABLED}, and each takes effect"
_GIVEN_DISABLED = f"with {ENABLED}:=false {RATE}:={LAUNCH_HZ}"
_IGNORED = "parameter ignored"


def _given_fast(seen: ParameterStarts) -> str:
    return f"{PREFIX}:={seen.prefix} {RATE}:={LAUNCH_HZ}"


def _judge_fast(seen: ParameterStarts) -> Verdict | None:
    """Return the failure that the start with a prefix and a fast rate shows."""
    if (start := seen.fast) is None:
        return None
    given, samples = _given_fast(seen), start.trace.samples_on(TOPIC)
    if not samples:
        step = steps.add_publisher(start.trace)
        cause = causes.diagnose_no_messages(start.trace, TOPIC, TYPE, answers=True, step=step)
        observed = f"with {given}: no message on {TOPIC}"
        return failed(_EXPECTED_AT_LAUNCH, observed, cause, causes.output_tail(start.trace))
    has_rate = start.rate is not None and start.rate.agrees_with(LAUNCH_HZ)
    without = find_without_prefix(samples, seen.prefix)
    if without:
        ignored = [] if has_rate else [RATE]
        ignored += [ENABLED] if seen.disabled is not None and seen.disabled.trace.samples_on(TOPIC) else []
        return failed(
            _EXPECTED_AT_LAUNCH,
            f'with {given}: "{text_of(without[-1])}"',
            _diagnose_ignored(PREFIX, start.trace, *ignored),
            [text_of(s) for s in samples[:6]],
        )
    if has_rate:
        return None
    observed = f"with {given}: {describe(start.rate, start.messages)}, not {LAUNCH_HZ} Hz ±{TOLERANCE:.0%}"
    cause = _diagnose_fast_rate_alone(start) or _diagnose_fast_rate(start, seen.slow)
    return failed(_EXPECTED_AT_LAUNCH, observed, cause)


def _judge_slow(seen: ParameterStarts) -> Verdict | None:
    """Return the failure that the start with a slow rate shows."""
    start = seen.slow
    if start is None or (start.rate is not None and start.rate.agrees_with(SLOW_LAUNCH_HZ)):
        return None
    given = f"{RATE}:={SLOW_LAUNCH_HZ}: {describe(start.rate, start.messages)}"
    cause = (
        causes.diagnose_process(start.trace)
        or diagnose_rounded_rate(start.rate, SLOW_LAUNCH_HZ, steps.use_parameter(start.trace, RATE))
        or _diagnose_other_rate(start.trace)
    )
    return failed(_EXPECTED_AT_LAUNCH, f"with {given}, not {SLOW_LAUNCH_HZ} Hz ±{TOLERANCE:.0%}", cause)


def _judge_disabled(seen: ParameterStarts) -> Verdict | None:
    """Return the failure that the start with `enabled` false shows."""
    if (start := seen.disabled) is None:
        return None
    trace, loud = start.trace, start.trace.samples_on(TOPIC)
    if loud:
        return failed(
            _EXPECTED_AT_LAUNCH,
            f"{_GIVEN_DISABLED}: {counted(len(loud), 'message')}",
            _diagnose_ignored(ENABLED, trace),
            [text_of(s) for s in loud[:3]],
        )
    broken = causes.diagnose_process(trace)
    held = start.enabled.value if start.enabled else None
    offered = any(p.topic == TOPIC for p in trace.graph.publishers)
    # A silent node with a publisher is disabled even if it answers no parameter call; one without a publisher must also
    # send messages once it is enabled.
    silent_on_purpose = held in (False, None) if offered else held is False and start.first_after_enable is not None
    if not broken and silent_on_purpose:
        return None
    return failed(
        _EXPECTED_AT_LAUNCH,
        f"{_GIVEN_DISABLED}: silence, but not because {ENABLED} is false",
        broken or _diagnose_ignored(ENABLED, trace),
        causes.output_tail(trace),
    )


def _diagnose_fast_rate_alone(start: RatedStart) -> Cause | None:
    """Diagnose a wrong rate by what does not depend on the rate of another start."""
    if (cause := causes.diagnose_same_name(start.trace)) is not None:
        return cause
    period_slip = find_in_files(
        start.trace, slips.diagnose_xor, period_slips.diagnose_second_timer, period_slips.diagnose_integer_period
    )
    if period_slip is not None:
        return period_slip
    if start.rate is not None and start.rate.in_bursts:
        return causes.diagnose_bursts(start.trace, steps.send_once_per_tick(start.trace))
    return find_in_files(start.trace, spinning.diagnose_untimed_spin_once)


def _diagnose_fast_rate(start: RatedStart, slow: RatedStart | None) -> Cause:
    rate, trace = start.rate, start.trace
    read = started_node(trace)
    if rate is not None and (rate.agrees_with(DEFAULT_HZ) or (slow and are_alike(rate, slow.rate))):
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
        period_slips.diagnose_second_timer,
        period_slips.diagnose_integer_period,
        lambda file: period_slips.diagnose_sleep(file, LAUNCH_HZ),
        period_slips.diagnose_throttle,
    ) or Cause("wrong rate", f"{RATE} has an effect, but not this one", steps.use_parameter(trace, RATE))


def _diagnose_ignored(name: str, trace: Trace, *others: str) -> Cause:
    return (
        find_in_files(trace, parameter_slips.diagnose_dropped_arguments)
        or steps.diagnose_override(trace, name)
        or Cause(
            _IGNORED,
            f"{name} given at start-up has no effect",
            steps.use_parameter(trace, name, *others),
        )
    )


@with_steps
def judge_bad_launch(plain: PlainStart, seen: Sequence[Trace], good: ParameterStarts) -> Verdict:
    """Judge `launch-validation`. `good`: starts with a good rate."""
    if not good.took_rate:
        because = f"the node does not take a good {RATE} at start-up either: see `launch-params`"
        return skipped(f"not judged, because {because}")
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
    shown_by = "runtime-params" if judge_defaults(seen).passed else "defaults"
    return ending.judge_ending(seen.trace, seen.ending, shown_by=shown_by)
