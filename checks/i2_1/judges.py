"""I2.1: the verdicts on starts of the node, with and without parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

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
from checks.i2_1.failures import are_alike, show
from tutor.judge import ending, tracebacks
from tutor.judge.rates import TOLERANCE, describe
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Level, Trace
from tutor.judge.verdict import Verdict, failed, passed, skipped
from tutor.judge.wording import counted, output_tail, shape
from tutor.ros_model import Parameter


def judge_defaults(seen: PlainStart) -> Verdict:
    expected = ", ".join(f"{name} = {show(value)} ({kind})" for name, (kind, value) in DEFAULTS.items())
    if seen.parameters is None:
        silent = Symptom.NO_ANSWER.seen(seen.trace, stuck=seen.stuck, answers=False)
        return failed(expected, "the node answers no parameter call", silent, output_tail(seen.trace))
    found = {name: seen.value_of(name) for name in DEFAULTS}
    observed = ", ".join(f"{n} = {show(p.value)} ({p.type})" if p else f"no {n}" for n, p in found.items())
    wrong = [name for name, (kind, value) in DEFAULTS.items() if not _matches(found[name], kind, value)]
    if wrong:
        name = wrong[0]
        kind, value = DEFAULTS[name]
        why = Symptom.NOT_DECLARED.seen(seen.trace, parameter=name, type=kind, default=value, found=found[name])
        return failed(expected, observed, why)
    return passed(expected, observed)


def judge_defaults_so_far(seen: PlainStart) -> Verdict | None:
    """Judge `defaults` as soon as the node has reported its parameters."""
    return judge_defaults(seen) if seen.parameters is not None else None


def _matches(parameter: Parameter | None, kind: str, value: Any) -> bool:
    return parameter is not None and (parameter.type, parameter.value) == (kind, value)


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
    """Judge `launch-params` by the fast start alone, where the slow one can show nothing more about why it fails."""
    failure, start = _judge_fast(seen), seen.fast
    if failure is None or start is None:
        return None
    samples = start.trace.samples_on(TOPIC)
    is_rate_wrong = bool(samples) and not find_without_prefix(samples, seen.prefix)
    return None if is_rate_wrong and seen.slow is None else judge_launch(seen)


_EXPECTED_AT_LAUNCH = f"--ros-args -p sets {PREFIX}, {RATE} and {ENABLED}, and each takes effect"
_GIVEN_DISABLED = f"with {ENABLED}:=false {RATE}:={LAUNCH_HZ}"


def _given_fast(seen: ParameterStarts) -> str:
    return f"{PREFIX}:={seen.prefix} {RATE}:={LAUNCH_HZ}"


def _judge_fast(seen: ParameterStarts) -> Verdict | None:
    """Return the failure that the start with a prefix and a fast rate shows."""
    if (start := seen.fast) is None:
        return None
    given, samples = _given_fast(seen), start.trace.samples_on(TOPIC)
    if not samples:
        missing = Symptom.NO_MESSAGES.seen(start.trace, topic=TOPIC, type=TYPE)
        observed = f"with {given}: no message on {TOPIC}"
        return failed(_EXPECTED_AT_LAUNCH, observed, missing, output_tail(start.trace))
    without = find_without_prefix(samples, seen.prefix)
    if without:
        observed = f'with {given}: "{text_of(without[-1])}"'
        return failed(_EXPECTED_AT_LAUNCH, observed, _ignored(PREFIX, start.trace), [text_of(s) for s in samples[:6]])
    if start.rate is not None and start.rate.agrees_with(LAUNCH_HZ):
        return None
    observed = f"with {given}: {describe(start.rate, start.messages)}, not {LAUNCH_HZ} Hz ±{TOLERANCE:.0%}"
    other = seen.slow.rate if seen.slow is not None else None
    unchanged = start.rate is not None and (start.rate.agrees_with(DEFAULT_HZ) or are_alike(start.rate, other))
    return failed(_EXPECTED_AT_LAUNCH, observed, _wrong_rate(start, LAUNCH_HZ, unchanged=unchanged))


def _judge_slow(seen: ParameterStarts) -> Verdict | None:
    """Return the failure that the start with a slow rate shows; the one with a fast rate showed none."""
    start = seen.slow
    if start is None or (start.rate is not None and start.rate.agrees_with(SLOW_LAUNCH_HZ)):
        return None
    given = f"{RATE}:={SLOW_LAUNCH_HZ}: {describe(start.rate, start.messages)}"
    observed = f"with {given}, not {SLOW_LAUNCH_HZ} Hz ±{TOLERANCE:.0%}"
    return failed(_EXPECTED_AT_LAUNCH, observed, _wrong_rate(start, SLOW_LAUNCH_HZ, unchanged=False))


def _judge_disabled(seen: ParameterStarts) -> Verdict | None:
    """Return the failure that the start with `enabled` false shows."""
    if (start := seen.disabled) is None:
        return None
    trace, loud = start.trace, start.trace.samples_on(TOPIC)
    if loud:
        return failed(
            _EXPECTED_AT_LAUNCH,
            f"{_GIVEN_DISABLED}: {counted(len(loud), 'message')}",
            _ignored(ENABLED, trace),
            [text_of(s) for s in loud[:3]],
        )
    broken = trace.exit is not None or tracebacks.last_traceback(trace) is not None or not trace.graph.nodes
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
        _ignored(ENABLED, trace),
        output_tail(trace),
    )


def _wrong_rate(start: RatedStart, asked: float, *, unchanged: bool) -> Observation:
    """A start with another rate than asked for; `unchanged`: the same whatever is asked for."""
    return Symptom.WRONG_RATE.seen(
        start.trace,
        parameter=RATE,
        wanted_hz=asked,
        rate=start.rate,
        unchanged=unchanged,
        inverted=start.rate is None or start.rate.agrees_with(1 / asked),
        at_start=True,
    )


def _ignored(name: str, trace: Trace) -> Observation:
    return Symptom.CHANGE_IGNORED.seen(trace, parameter=name, at_start=True)


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
            why = Symptom.BAD_VALUE_ACCEPTED.seen(
                trace, parameter=RATE, value=trace.parameters[RATE], at_start=True, warning=warning
            )
            observed = f"with {given}: {found.plain if found else warning or 'no message about it'}"
            return failed(expected, observed, why, output_tail(trace))
    return passed(expected, "it does", [messages_naming_rate(trace)[-1] for trace in seen])


def _wording(line: str) -> str:
    """Strip a line of numbers and its log prefix, so that it can be compared with those of an ordinary start."""
    return shape(line.rsplit("]: ", 1)[-1])


def judge_shutdown(seen: PlainStart) -> Verdict:
    shown_by = "runtime-params" if judge_defaults(seen).passed else "defaults"
    return ending.judge_ending(seen.trace, seen.ending, shown_by=shown_by)
