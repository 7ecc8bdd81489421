"""I2.1: the verdicts, as pure functions of the facts."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from checks.i2_1 import steps
from checks.i2_1.facts import (
    BAD_RATES,
    DEFAULT_HZ,
    DEFAULTS,
    DOWN_HZ,
    ENABLED,
    LAUNCH_HZ,
    MIN_BURST,
    PREFIX,
    RATE,
    SLOW_LAUNCH_HZ,
    TOPIC,
    TYPE,
    UP_HZ,
    VALIDATION_HZ,
    AtomicRequests,
    BadRates,
    ParameterStarts,
    PlainStart,
    RateChanges,
    RuntimeChanges,
    messages_naming_rate,
    text_of,
)
from tutor.judge import causes, ending, tracebacks
from tutor.judge.causes import names, parameter_slips, period_slips, slips
from tutor.judge.rates import TOLERANCE, Rate, describe
from tutor.judge.rewriting.node import started_node
from tutor.judge.rewriting.whole import with_applicable_steps
from tutor.judge.trace import Level, SetAnswer, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Cause, Verdict, failed, passed
from tutor.judge.wording import counted, shape
from tutor.ros_model import Parameter


def _traces(*facts: object) -> list[Trace]:
    return [trace for each in facts if isinstance(trace := getattr(each, "trace", None), Trace)]


def _with_steps[**P](judge: Callable[P, Verdict]) -> Callable[P, Verdict]:
    return with_applicable_steps(judge, _traces, steps.whole_program_step)


@_with_steps
def judge_defaults(seen: PlainStart) -> Verdict:
    expected = ", ".join(f"{name} = {_show(value)} ({kind})" for name, (kind, value) in DEFAULTS.items())
    if seen.parameters is None:
        cause = _diagnose_no_answer(seen.trace, seen.stuck)
        return failed(expected, "the node answers no parameter call", cause, causes.output_tail(seen.trace))
    found = {name: seen.value_of(name) for name in DEFAULTS}
    observed = ", ".join(f"{n} = {_show(p.value)} ({p.type})" if p else f"no {n}" for n, p in found.items())
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
    return Cause("wrong default", f"{name} is {_show(parameter.value)}, not {_show(value)}", step)


@_with_steps
def judge_launch(seen: ParameterStarts) -> Verdict:
    expected = f"--ros-args -p sets {PREFIX}, {RATE} and {ENABLED}, and each takes effect"
    samples = seen.trace.samples_on(TOPIC)
    given = f"{PREFIX}:={seen.prefix} {RATE}:={LAUNCH_HZ}"
    if not samples:
        cause = causes.diagnose_no_messages(seen.trace, TOPIC, TYPE, answers=True, step=steps.add_publisher(seen.trace))
        return failed(expected, f"with {given}: no message on {TOPIC}", cause, causes.output_tail(seen.trace))
    without = [text_of(sample) for sample in samples[-2:] if seen.prefix not in text_of(sample)]
    if without:
        return failed(
            expected,
            f'with {given}: "{without[-1]}"',
            _diagnose_ignored(PREFIX, seen.trace),
            [text_of(s) for s in samples[:6]],
        )
    if seen.rate is None or not seen.rate.agrees_with(LAUNCH_HZ):
        observed = f"with {given}: {describe(seen.rate, seen.messages)}, not {LAUNCH_HZ} Hz ±{TOLERANCE:.0%}"
        return failed(expected, observed, causes.diagnose_same_name(seen.trace) or _diagnose_launch_rate(seen))
    if seen.slow_rate is None or not seen.slow_rate.agrees_with(SLOW_LAUNCH_HZ):
        slow = f"{RATE}:={SLOW_LAUNCH_HZ}: {describe(seen.slow_rate, seen.slow_messages)}"
        cause = (
            causes.diagnose_process(seen.slow)
            or _diagnose_rounded_rate(seen.slow_rate, SLOW_LAUNCH_HZ, steps.use_parameter(seen.slow, RATE))
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
    if (cause := period_slips.diagnose_integer_period(started_node(trace))) is not None:
        return cause
    if rate is not None and rate.in_bursts:
        return causes.diagnose_bursts(steps.send_once_per_tick(trace))
    if rate is not None and (rate.agrees_with(DEFAULT_HZ) or _are_alike(rate, seen.slow_rate)):
        return _diagnose_ignored(RATE, trace)
    if rate is None or rate.agrees_with(1 / LAUNCH_HZ):
        return causes.diagnose_rate_as_period(RATE, steps.use_parameter(trace, RATE))
    return _diagnose_other_rate(trace)


def _are_alike(rate: Rate, other: Rate | None) -> bool:
    """Whether two rates are about the same, although different ones were requested."""
    return other is not None and max(rate.hz, other.hz) < 1.1 * min(rate.hz, other.hz)


def _diagnose_other_rate(trace: Trace) -> Cause:
    read = started_node(trace)
    return (
        period_slips.diagnose_integer_period(read)
        or period_slips.diagnose_sleep(read, LAUNCH_HZ)
        or Cause("wrong rate", f"{RATE} has an effect, but not this one", steps.use_parameter(trace, RATE))
    )


def _diagnose_rounded_rate(rate: Rate | None, asked: float, step: str) -> Cause | None:
    """Diagnose a rounded rate: 1.5 Hz that becomes 1 or 2 Hz, or 0.75 Hz that becomes 1 Hz."""
    rounded = {math.floor(asked), math.ceil(asked)} - {asked}
    if rate is None or not any(abs(rate.hz - hz) < 0.1 for hz in rounded):
        return None
    return Cause("rate made a whole number", f"{RATE} {asked} is treated as {rate.hz:.0f}", step)


def _diagnose_ignored(name: str, trace: Trace) -> Cause:
    return steps.diagnose_override(trace, name) or Cause(
        "parameter ignored", f"{name} given at start-up has no effect", steps.use_parameter(trace, name)
    )


EXPECTED_CHANGES = f"setting {PREFIX} and {ENABLED} on the running node takes effect within one period"


@_with_steps
def judge_changes(seen: RuntimeChanges) -> Verdict:
    """Judge `runtime-params`, apart from a rate that differs afterwards: `timer` may show why."""
    if seen.set_prefix is None:
        return _fail_not_running(seen, EXPECTED_CHANGES)
    for answer in (seen.set_prefix, seen.set_off, seen.set_later, seen.set_on):
        if answer is not None and not (answer.answered and answer.successful):
            return _fail_not_set(EXPECTED_CHANGES, answer, seen.trace, seen.stuck)
    expected = EXPECTED_CHANGES
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


@_with_steps
def judge_runtime(seen: RuntimeChanges, retimed: RateChanges) -> Verdict:
    verdict = judge_changes(seen)
    # If a timer is left running whenever a parameter is set, it is up to `timer` to report that.
    if not verdict.passed or not judge_timer(retimed).passed:
        return verdict
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
    if _rate_is_unchanged(seen.rate, seen.base_hz, seen):
        return None
    observed = f"{actions}: {describe(seen.rate, len(texts))}, not {seen.base_hz:g} Hz ±{TOLERANCE:.0%} as before"
    return failed(
        expected,
        observed,
        (causes.diagnose_process(seen.trace) if seen.trace.exit else None)
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
    read = started_node(trace)
    old = parameter_slips.diagnose_old_value_read(read, name)
    if (
        cause := parameter_slips.diagnose_override(read, name) or parameter_slips.diagnose_uncalled_callback(read)
    ) is not None:
        return cause
    if old is not None:
        return replace(old, hint=old.hint or steps.use_parameter_later(trace, name))
    text = f"{name} is accepted, but what the node sends does not follow it"
    return Cause("parameter ignored", text, steps.use_parameter_later(trace, name))


def _last_text(trace: Trace) -> str:
    samples = trace.samples_on(TOPIC)
    return text_of(samples[-1]) if samples else "nothing"


def _fail_not_running(seen: RuntimeChanges | BadRates | RateChanges | AtomicRequests, expected: str) -> Verdict:
    trace, stuck = seen.trace, seen.stuck
    if trace.samples_on(TOPIC):
        return failed(
            expected,
            "the node answers no parameter call",
            _diagnose_no_answer(trace, stuck),
            causes.output_tail(trace),
        )
    cause = causes.diagnose_no_messages(
        trace, TOPIC, TYPE, answers=seen.answering, stuck=stuck, step=steps.add_publisher(trace)
    )
    return failed(expected, f"no message on {TOPIC} to start with", cause, causes.output_tail(trace))


def _diagnose_no_answer(trace: Trace, stuck: Sequence[Frame], *, spins: bool = False) -> Cause:
    """Diagnose a node that answers nothing; if a callback blocks, the step removes the wait."""
    cause = causes.diagnose_no_answer(trace, stuck, spins=spins)
    blocked = causes.diagnose_blocked(trace, stuck, spins=spins)
    return replace(cause, hint=steps.remove_waits(trace, stuck)) if cause == blocked else cause


def _fail_not_set(expected: str, answer: SetAnswer, trace: Trace, stuck: Sequence[Frame]) -> Verdict:
    what = ", ".join(f"{name} to {_show(value)}" for name, value in answer.values.items())
    if not answer.answered:
        cause = _diagnose_no_answer(trace, stuck, spins=True)
        observed = f"setting {what}: {causes.describe_no_answer(trace, answer.took_s)}"
        return failed(expected, observed, cause, causes.output_tail(trace))
    cause = causes.diagnose_refusal(answer.reason, steps.accept_value(trace, answer))
    return failed(expected, f'setting {what}: rejected, "{answer.reason}"', cause)


def _fail_if_crashed(bad: float, expected: str, trace: Trace) -> Verdict | None:
    """Fail a node that crashed because it accepted a bad rate and created a timer from it."""
    found = tracebacks.last_traceback(trace)
    raised = found.raised if found is not None and trace.exit is not None else ""
    if not raised.startswith("ZeroDivisionError") and "timer period must be non-negative" not in raised:
        return None
    cause = _diagnose_no_validation(trace, bad)
    return failed(expected, f"{RATE} set to {bad} ends the node: {raised}", cause, causes.output_tail(trace))


@_with_steps
def judge_validation(seen: BadRates, switched: RuntimeChanges) -> Verdict:
    expected = _expected_refusal(seen)
    if not seen.rejected:
        return _fail_not_running(seen, expected)
    if (accepted := _fail_if_not_refused(seen, expected)) is not None:
        return accepted
    if not _rate_is_unchanged(seen.rate, seen.base_hz, switched):
        cause = causes.diagnose_process(seen.trace) if seen.trace.exit else None
        cause = cause or _diagnose_change(seen.trace, "the rate changes although the value was rejected")
        return failed(expected, f"after the rejection: {describe(seen.rate, seen.messages)}", cause)
    return passed(expected, f'rejected: "{seen.rejected[0][0].reason}"; still {seen.rate}')


@_with_steps
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
            return _fail_if_crashed(bad, expected, seen.trace) or _fail_not_set(
                expected, answer, seen.trace, seen.stuck
            )
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
            return _fail_not_set(expected, answer, seen.trace, seen.stuck)
        if value != seen.before:
            return failed(
                expected,
                f"{bad} was rejected, but {RATE} is {_show(value)} now",
                _diagnose_change(seen.trace, "the value is not what it was"),
            )
    return None


def _diagnose_change(trace: Trace, text: str) -> Cause:
    return parameter_slips.diagnose_callback_order(started_node(trace)) or Cause(
        "value changed all the same", text, steps.refuse_bad_rates(trace)
    )


@_with_steps
def judge_timer(seen: RateChanges) -> Verdict:
    expected = f"setting {RATE} changes the measured rate: {UP_HZ} Hz, then {DOWN_HZ} Hz, ±{TOLERANCE:.0%}"
    if not seen.steps:
        return _fail_not_running(seen, expected)
    for answer, rate, messages in seen.steps:
        asked = answer.values[RATE]
        if not answer.answered or not answer.successful:
            return _fail_not_set(expected, answer, seen.trace, seen.stuck)
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
    integer_period = period_slips.diagnose_integer_period(read)
    if rate is not None and rate.in_bursts:
        return integer_period or causes.diagnose_bursts(steps.send_once_per_tick(trace))
    if rate is not None and rate.hz < asked and (asleep := period_slips.diagnose_sleep(read, asked)) is not None:
        return asleep
    before = DEFAULT_HZ if asked == UP_HZ else UP_HZ
    faster = seen.steps[0][1]
    left_behind = asked == DOWN_HZ and faster is not None and faster.hz > UP_HZ + DEFAULT_HZ / 2
    if rate is not None and rate.agrees_with(before) and not left_behind:
        return _diagnose_old_period(trace)
    if rate is not None and rate.hz < UP_HZ and all(_are_alike(rate, other) for _, other, _ in seen.steps):
        return _diagnose_old_period(trace)
    if (rounded := _diagnose_rounded_rate(rate, asked, steps.follow_changes(trace))) is not None:
        return rounded
    if rate is not None and rate.hz > asked:
        return integer_period or causes.diagnose_old_timer(rate.hz, asked, steps.cancel_old_timer(trace))
    if rate is None or rate.agrees_with(1 / asked):
        return integer_period or causes.diagnose_rate_as_period(RATE, steps.follow_changes(trace))
    return Cause("wrong rate", f"{rate.hz:.1f} Hz instead of {asked:g} Hz", steps.follow_changes(trace))


def _diagnose_old_period(trace: Trace) -> Cause:
    """Diagnose a timer that keeps its old period although the parameter has a new value."""
    read = started_node(trace)
    if (cause := parameter_slips.diagnose_override(read, RATE)) is not None:
        return cause
    if (old := parameter_slips.diagnose_old_value_read(read, RATE)) is not None:
        return replace(old, hint=old.hint or steps.follow_changes(trace))
    text = "the parameter changes, but the timer keeps its old period"
    return parameter_slips.diagnose_uncalled_callback(read) or Cause(
        names.TIMER_NOT_REPLACED, text, steps.follow_changes(trace)
    )


def _diagnose_no_validation(trace: Trace, bad: float) -> Cause:
    """Diagnose a node that accepts a bad rate."""
    read = started_node(trace)
    return parameter_slips.diagnose_uncalled_callback(read) or Cause(
        "no validation", parameter_slips.why_accepted(read, bad), steps.refuse_bad_rates(trace)
    )


def _rate_is_unchanged(rate: Rate | None, hz: float, switched: RuntimeChanges) -> bool:
    """Whether the rate is still `hz`, or the one the node has actually published at from the start."""
    if rate is None or rate.agrees_with(hz):
        return rate is not None
    # A node at VALIDATION_HZ has just been measured at exactly that rate, so the initial one is no excuse.
    return hz != VALIDATION_HZ and switched.before is not None and switched.before.agrees_with(rate.hz)


@_with_steps
def judge_atomic(seen: AtomicRequests, switched: RuntimeChanges) -> Verdict:
    expected = f"an atomic set of a good {PREFIX} and a bad {RATE}, in either order, changes nothing at all"
    if not seen.answers:
        return _fail_not_running(seen, expected)
    unanswered = next((answer for answer in seen.answers if not answer.answered), None)
    if unanswered is not None:
        return _fail_if_crashed(BAD_RATES[1], expected, seen.trace) or _fail_not_set(
            expected, unanswered, seen.trace, seen.stuck
        )
    if any(answer.successful for answer in seen.answers):
        return failed(
            expected,
            "the request was accepted",
            _diagnose_no_validation(seen.trace, BAD_RATES[1]),
        )
    if "declared" in seen.answers[0].reason:
        return _fail_not_set(expected, seen.answers[0], seen.trace, seen.stuck)
    changed = next((held for held in seen.values if held != seen.before), None)
    partial = steps.check_all_first(seen.trace)
    if changed is not None or seen.shown is not None:
        now = f'a message reads "{text_of(seen.shown)}"' if seen.shown else f"{PREFIX}, {RATE} are {changed}"
        return failed(
            expected,
            f"rejected, but {now}",
            parameter_slips.diagnose_callback_order(started_node(seen.trace))
            or Cause(
                "partial change", "the callback applies the first parameter before it looks at the second", partial
            ),
        )
    if not _rate_is_unchanged(seen.rate, seen.base_hz, switched):
        return failed(
            expected,
            f"rejected, but then {describe(seen.rate, seen.messages)}",
            Cause("partial change", "the timer was touched although the request was rejected", partial),
        )
    return passed(expected, f'both rejected ("{seen.answers[0].reason}"), nothing changed')


@_with_steps
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


def _show(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else repr(value) if isinstance(value, str) else str(value)
