"""I2.1 Parameterized Publisher: three parameters that work at start-up and at run time, validated, with one timer."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tutor.judge import causes, ending, tracebacks
from tutor.judge.bench import Bench, Run
from tutor.judge.check import Check, Criterion
from tutor.judge.rates import TOLERANCE, Rate, describe
from tutor.judge.trace import Ending, Parameter, Sample, SetAnswer, Trace
from tutor.judge.verdict import Cause, Verdict, failed, passed
from tutor.judge.waiting import START_S, appears, first_message, steady_rate

FILE = "parameterized_publisher.py"
TOPIC = "/chatter"
TYPE = "std_msgs/msg/String"
PREFIX, RATE, ENABLED = "message_prefix", "publish_rate", "enabled"

DEFAULTS: Mapping[str, tuple[str, Any]] = {PREFIX: ("string", "Hello"), RATE: ("double", 1.0), ENABLED: ("boolean", True)}
DEFAULT_HZ = 1.0
LAUNCH_HZ = 5.0
UP_HZ, DOWN_HZ = 10.0, 2.0
BAD_RATES = (0.0, -1.0)
ANSWER_S = 5.0
"""A parameter call is answered within this time, else it is not answered."""

RARE_S = 3.0
"""At 1 Hz or more, a publisher that exists sends something within this time, late as it may be."""

RCLPYS_OWN = (
    "Callback returned an invalid type",
    "Wrong parameter type",
    "Trying to set a read-only parameter",
    "parameter list cannot be empty",
    "not been declared",
    "Invalid access to undeclared",
    "cannot be set",
)
"""Reasons that rclpy gives by itself: they are not the learner's. (That a value is outside a declared range is.)"""


@dataclass(frozen=True)
class Survey:
    trace: Trace
    parameters: tuple[Parameter, ...] | None
    ending: Ending | None

    def value_of(self, name: str) -> Parameter | None:
        return _find(self.parameters or (), name)


@dataclass(frozen=True)
class Launched:
    """Starts with parameters: one with a prefix and a rate, one with enabled false."""

    prefix: str
    trace: Trace
    rate: Rate | None
    messages: int
    disabled: Trace
    disabled_answer: Parameter | None
    disabled_for_s: float


@dataclass(frozen=True)
class Switched:
    """A plain start on which message_prefix and enabled are set."""

    trace: Trace
    prefix: str
    set_prefix: SetAnswer | None = None
    after_prefix: Sample | None = None
    set_off: SetAnswer | None = None
    sent_while_off: tuple[Sample, ...] = ()
    off_for_s: float = 0.0
    set_on: SetAnswer | None = None
    resumed: Sample | None = None


@dataclass(frozen=True)
class Validated:
    """A plain start on which bad rates are asked for. `rejected` pairs each answer with the value held afterwards."""

    trace: Trace
    base_hz: float = DEFAULT_HZ
    before: Any = DEFAULT_HZ
    rejected: tuple[tuple[SetAnswer, Any], ...] = ()
    rate: Rate | None = None
    messages: int = 0


@dataclass(frozen=True)
class Retimed:
    """A plain start on which publish_rate is set to a faster and then to a slower rate."""

    trace: Trace
    steps: tuple[tuple[SetAnswer, Rate | None, int], ...] = ()


@dataclass(frozen=True)
class Atomic:
    trace: Trace
    base_hz: float = DEFAULT_HZ
    answers: tuple[SetAnswer, ...] = ()
    before: tuple[Any, ...] = ()
    values: tuple[tuple[Any, ...], ...] = ()
    shown: Sample | None = None
    rate: Rate | None = None
    messages: int = 0


# --- scenarios ---------------------------------------------------------------------------------------------------------


async def survey(bench: Bench) -> Survey:
    """A plain start: which parameters has it, and does Ctrl+C end it cleanly?"""
    async with bench.start(FILE, watch={TOPIC: TYPE}) as run:
        bench.doing(0.2, "asking for its parameters")
        node = await _node(run)
        declared = await run.parameters(ANSWER_S) if node else None
        bench.doing(0.5, "waiting for a message, then pressing Ctrl+C")
        if node:
            await first_message(run, TOPIC, TYPE, rare_s=RARE_S)
        trace = run.trace()
        ended = await run.interrupt() if run.exit is None else None
        return Survey(trace, declared, ended)


async def launched(bench: Bench) -> Launched:
    """Start it with each parameter given on the command line."""
    prefix = "Ahoy7"

    async def loud() -> tuple[Trace, Rate | None, int]:
        async with bench.start(FILE, parameters={PREFIX: prefix, RATE: LAUNCH_HZ}, watch={TOPIC: TYPE}) as run:
            bench.doing(0.2, f"{PREFIX}:={prefix} {RATE}:={LAUNCH_HZ}")
            if not await first_message(run, TOPIC, TYPE, rare_s=RARE_S):
                return run.trace(), None, 0
            rate, messages = await steady_rate(run, TOPIC, LAUNCH_HZ, since=run.on(TOPIC)[0].source_time)
            return run.trace(), rate, messages

    async def silent() -> tuple[Trace, Parameter | None, float]:
        async with bench.start(FILE, parameters={ENABLED: False, RATE: LAUNCH_HZ}, watch={TOPIC: TYPE}) as run:
            bench.doing(0.3, f"{ENABLED}:=false, listening for silence")
            node = await _node(run)
            declared = await run.parameters(ANSWER_S) if node else None
            await appears(run, lambda: any(p.topic == TOPIC for p in run.graph.publishers))
            since = run.now()
            # Two periods of the default rate, in case the rate that was given here is not heeded.
            await run.until(lambda: bool(run.on(TOPIC)) or run.now() - since >= 2.2 / DEFAULT_HZ, 4.0)
            return run.trace(), _find(declared or (), ENABLED), run.now() - since

    (trace, rate, messages), (disabled, answer, quiet) = await asyncio.gather(loud(), silent())
    return Launched(prefix, trace, rate, messages, disabled, answer, quiet)


async def switched(bench: Bench) -> Switched:
    """Set message_prefix and enabled while it runs. A change may take one period of the rate to show."""
    prefix = "Servus7"
    async with bench.start(FILE, watch={TOPIC: TYPE}) as run:
        bench.doing(0.05, "waiting for it to publish")
        node = await _publishing(run)
        if node is None:
            return Switched(run.trace(), prefix)
        period = 1 / await _base_hz(run)
        bench.doing(0.2, f"setting {PREFIX} to {prefix}")
        set_prefix = await run.set_parameters(node, {PREFIX: prefix}, limit_s=ANSWER_S)
        due = set_prefix.answered_at + period + 0.1

        def shown() -> Sample | None:
            return next((s for s in run.on(TOPIC) if s.source_time > set_prefix.asked_at and prefix in _text(s)), None)

        def old() -> Sample | None:
            return next((s for s in run.on(TOPIC) if s.source_time > due and prefix not in _text(s)), None)

        await run.until(lambda: shown() is not None or old() is not None, 2 * period + 2)
        changed = shown()
        bench.doing(0.4, f"setting {ENABLED} to false, listening for silence")
        set_off = await run.set_parameters(node, {ENABLED: False}, limit_s=ANSWER_S)
        quiet_from = set_off.answered_at + period + 0.1

        def noise() -> list[Sample]:
            return [s for s in run.on(TOPIC) if s.source_time > quiet_from]

        await run.until(lambda: bool(noise()) or run.now() >= quiet_from + 1.5 * period, 3 * period + 2)
        sent, off_for = tuple(noise()), run.now() - set_off.answered_at
        bench.doing(0.7, f"setting {ENABLED} to true")
        set_on = await run.set_parameters(node, {ENABLED: True}, limit_s=ANSWER_S)

        def resumed() -> Sample | None:
            return next((s for s in run.on(TOPIC) if s.source_time > set_on.asked_at), None)

        await run.until(lambda: resumed() is not None, 2 * period + 2)
        return Switched(run.trace(), prefix, set_prefix, changed, set_off, sent, off_for, set_on, resumed())


async def validated(bench: Bench) -> Validated:
    """Ask for bad rates, which must change nothing."""
    async with bench.start(FILE, watch={TOPIC: TYPE}) as run:
        bench.doing(0.05, "waiting for it to publish")
        node = await _publishing(run)
        if node is None:
            return Validated(run.trace())
        base_hz, (before,) = await _base_hz(run), await _held(run, (RATE,))
        rejected: list[tuple[SetAnswer, Any]] = []
        for bad in BAD_RATES:
            bench.doing(0.2, f"setting {RATE} to {bad}")
            answer = await run.set_parameters(node, {RATE: bad}, limit_s=ANSWER_S)
            rejected.append((answer, (await _held(run, (RATE,)))[0]))
        bench.doing(0.4, "measuring the rate after it")
        rate, messages = await steady_rate(run, TOPIC, base_hz, since=rejected[-1][0].answered_at)
        return Validated(run.trace(), base_hz, before, tuple(rejected), rate, messages)


async def retimed(bench: Bench) -> Retimed:
    """Ask for a faster and then for a slower rate; each may take effect after one period of the old one."""
    async with bench.start(FILE, watch={TOPIC: TYPE}) as run:
        bench.doing(0.05, "waiting for it to publish")
        node = await _publishing(run)
        if node is None:
            return Retimed(run.trace())
        steps: list[tuple[SetAnswer, Rate | None, int]] = []
        old_hz = await _base_hz(run)
        for done, new_hz in ((0.3, UP_HZ), (0.6, DOWN_HZ)):
            bench.doing(done, f"setting {RATE} to {new_hz}")
            answer = await run.set_parameters(node, {RATE: new_hz}, limit_s=ANSWER_S)
            settled = answer.answered_at + 1 / old_hz + 0.05
            await run.until(lambda settled=settled: run.now() >= settled, 1 / old_hz + 1)  # type: ignore[misc]
            rate, messages = await steady_rate(run, TOPIC, new_hz, since=settled)
            steps.append((answer, rate, messages))
            old_hz = new_hz
        return Retimed(run.trace(), tuple(steps))


async def atomic(bench: Bench) -> Atomic:
    """Set a good prefix and a bad rate in one atomic request, in either order."""
    async with bench.start(FILE, watch={TOPIC: TYPE}) as run:
        node = await _publishing(run)
        if node is None:
            return Atomic(run.trace())
        base_hz = await _base_hz(run)
        before = await _held(run, (PREFIX, RATE))
        tokens = ("Partial1", "Partial2")
        answers: list[SetAnswer] = []
        values: list[tuple[Any, ...]] = []
        for request in ({PREFIX: tokens[0], RATE: BAD_RATES[1]}, {RATE: BAD_RATES[1], PREFIX: tokens[1]}):
            bench.doing(0.4, f"setting {' and '.join(request)} atomically")
            answers.append(await run.set_parameters(node, request, atomic=True, limit_s=ANSWER_S))
            values.append(await _held(run, (PREFIX, RATE)))
        rate, messages = await steady_rate(run, TOPIC, base_hz, since=answers[-1].answered_at)
        shown = next((s for s in run.on(TOPIC) if any(token in _text(s) for token in tokens)), None)
        return Atomic(run.trace(), base_hz, tuple(answers), before, tuple(values), shown, rate, messages)


async def bad_launches(bench: Bench) -> tuple[Trace, ...]:
    """Start it with a bad rate: does it say which parameter is wrong?"""

    async def one(bad: float) -> Trace:
        async with bench.start(FILE, parameters={RATE: bad}, watch={TOPIC: TYPE}) as run:
            bench.doing(0.3, f"starting with {RATE}:={bad}")
            await appears(run, lambda: run.exit is not None or bool(_naming(run.trace())))
            await run.until(lambda: run.exit is not None, 1.0)  # what it says may come in more than one message
            return run.trace()

    return tuple(await asyncio.gather(*(one(bad) for bad in BAD_RATES)))


async def _node(run: Run) -> str | None:
    """The node to talk to: the one that has most of the parameters. None where no node answers."""

    def offers() -> list[str]:
        return [s.name.removesuffix("/set_parameters") for s in run.graph.services if s.name.endswith("/set_parameters")]

    if not await run.until(lambda: bool(offers()), START_S):
        return None
    declared = await run.parameters(ANSWER_S)
    if declared is None:
        return None
    holders = [parameter.node for parameter in declared if parameter.name in DEFAULTS] or offers()
    return max(holders, key=holders.count) if holders else None


async def _publishing(run: Run) -> str | None:
    """The node to talk to, once it publishes; None where it does not."""
    node = await _node(run)
    return node if node is not None and await first_message(run, TOPIC, TYPE, rare_s=RARE_S) else None


async def _held(run: Run, names: Sequence[str]) -> tuple[Any, ...]:
    """The values that the node says these parameters have; None for one that it does not have."""
    declared = await run.parameters(ANSWER_S) or ()
    found = [_find(declared, name) for name in names]
    return tuple(parameter.value if parameter else None for parameter in found)


async def _base_hz(run: Run) -> float:
    """The rate that the node declares to begin with: 1.0 Hz, or what a wrong default says."""
    value = (await _held(run, (RATE,)))[0]
    return float(value) if isinstance(value, (int, float)) and 0.5 <= value <= 10 else DEFAULT_HZ


def _find(parameters: Sequence[Parameter], name: str) -> Parameter | None:
    return next((parameter for parameter in parameters if parameter.name == name), None)


def _text(sample: Sample) -> str:
    return str(sample.message["data"])


def _naming(trace: Trace) -> list[str]:
    """The messages, logged or printed, that name publish_rate; the source lines in a traceback do not count."""
    lines = [*(log.text for log in trace.logs), *tracebacks.without(trace.output)]
    return [line for line in lines if RATE in line]


def _shape(line: str) -> str:
    """A line without its numbers and its log prefix: what an ordinary start says too is no message about a bad value."""
    return re.sub(r"-?\d+(\.\d+)?", "#", line.rsplit("]: ", 1)[-1])


# --- judges ------------------------------------------------------------------------------------------------------------


def judge_defaults(seen: Survey) -> Verdict:
    expected = ", ".join(f"{name} = {_show(value)} ({kind})" for name, (kind, value) in DEFAULTS.items())
    if seen.parameters is None:
        cause = causes.of_process(seen.trace) or causes.no_spin(seen.trace)
        return failed(expected, "the node answers no parameter call", cause, causes.last_words(seen.trace))
    found = {name: seen.value_of(name) for name in DEFAULTS}
    observed = ", ".join(f"{n} = {_show(p.value)} ({p.type})" if p else f"no {n}" for n, p in found.items())
    for name, parameter in found.items():
        kind, value = DEFAULTS[name]
        if parameter is None:
            return failed(expected, observed, Cause("parameter not declared", f"the node has no parameter {name}",
                                                    f"self.declare_parameter('{name}', {value!r})"))
        if parameter.type != kind:
            name_of_cause = "integer parameter" if (kind, parameter.type) == ("double", "integer") else "wrong parameter type"
            return failed(expected, observed, Cause(name_of_cause, f"{name} is of type {parameter.type}, not {kind}: the type "
                                                    "of the default is the type of the parameter",
                                                    f"self.declare_parameter('{name}', {value!r})"))
        if parameter.value != value:
            return failed(expected, observed, Cause("wrong default", f"{name} is {_show(parameter.value)}, not {_show(value)}",
                                                    f"self.declare_parameter('{name}', {value!r})"))
    return passed(expected, observed)


def judge_launch(seen: Launched) -> Verdict:
    expected = f"--ros-args -p sets {PREFIX}, {RATE} and {ENABLED}, and each takes effect"
    samples = seen.trace.on(TOPIC)
    given = f"{PREFIX}:={seen.prefix} {RATE}:={LAUNCH_HZ}"
    if not samples:
        cause = causes.of_silence(seen.trace, TOPIC, TYPE, answers=True)
        return failed(expected, f"with {given}: no message on {TOPIC}", cause, causes.last_words(seen.trace))
    if not any(seen.prefix in _text(sample) for sample in samples):
        return failed(expected, f"with {given}: \"{_text(samples[-1])}\"", _ignored(PREFIX), [_text(s) for s in samples[:3]])
    if seen.rate is None or not seen.rate.agrees(LAUNCH_HZ):
        observed = f"with {given}: {describe(seen.rate, seen.messages)}, not {LAUNCH_HZ} Hz ±{TOLERANCE:.0%}"
        return failed(expected, observed, _why_launch_rate(seen.rate))
    off = f"with {ENABLED}:=false {RATE}:={LAUNCH_HZ}"
    loud = seen.disabled.on(TOPIC)
    if loud:
        return failed(expected, f"{off}: {len(loud)} messages", _ignored(ENABLED), [_text(s) for s in loud[:3]])
    broken = causes.of_process(seen.disabled)
    silent_on_purpose = any(p.topic == TOPIC for p in seen.disabled.graph.publishers)
    if broken or not silent_on_purpose or (seen.disabled_answer and seen.disabled_answer.value is not False):
        return failed(expected, f"{off}: silence, but not because {ENABLED} is false", broken or _ignored(ENABLED),
                      causes.last_words(seen.disabled))
    return passed(expected, f"with {given}: \"{_text(samples[-1])}\" at {seen.rate}; {off}: silence for "
                            f"{seen.disabled_for_s:.1f} s")


def _why_launch_rate(rate: Rate | None) -> Cause:
    if rate is not None and rate.agrees(DEFAULT_HZ):
        return _ignored(RATE)
    if rate is None or rate.agrees(1 / LAUNCH_HZ):
        return _as_period()
    return Cause("wrong rate", f"{RATE} has an effect, but not this one", f"the timer's period is 1.0 / {RATE}")


def _ignored(name: str) -> Cause:
    return Cause(
        "parameter ignored",
        f"{name} given at start-up has no effect",
        f"read it after declaring it: self.get_parameter('{name}').value",
    )


def _as_period() -> Cause:
    return Cause("rate used as a period", f"the timer waits {RATE} seconds", f"the timer's period is 1.0 / {RATE}")


def judge_runtime(seen: Switched) -> Verdict:
    expected = f"setting {PREFIX} and {ENABLED} on the running node takes effect within one period"
    if seen.set_prefix is None or seen.set_off is None or seen.set_on is None:
        return _not_running(seen.trace, expected)
    for answer in (seen.set_prefix, seen.set_off, seen.set_on):
        if not answer.answered or not answer.successful:
            return _not_set(expected, answer, seen.trace)
    if seen.after_prefix is None:
        return failed(expected, f"{PREFIX} set to {seen.prefix}, but the messages still read \"{_last(seen.trace)}\"",
                      _ignored_later(PREFIX))
    if seen.sent_while_off:
        return failed(expected, f"{ENABLED} set to false, but {len(seen.sent_while_off)} messages more than a period later",
                      _ignored_later(ENABLED), [_text(s) for s in seen.sent_while_off[:3]])
    if seen.resumed is None:
        cause = causes.of_process(seen.trace) if seen.trace.exit else None
        return failed(expected, f"{ENABLED} set to false and to true again: no message since", cause or Cause(
            "does not resume", f"{ENABLED} true does not bring the messages back",
            "let the timer run on, and only skip publish() while enabled is false; or make the timer again"))
    return passed(expected, f"\"{_text(seen.after_prefix)}\"; silence while false; resumed "
                            f"{seen.resumed.source_time - seen.set_on.asked_at:.2f} s after true")


def _ignored_later(name: str) -> Cause:
    return Cause(
        "parameter ignored",
        f"{name} is accepted, but what the node sends does not follow it",
        f"read it in every callback (self.get_parameter('{name}').value), or keep it up to date in a parameter callback",
    )


def _last(trace: Trace) -> str:
    samples = trace.on(TOPIC)
    return _text(samples[-1]) if samples else "nothing"


def _not_running(trace: Trace, expected: str) -> Verdict:
    if trace.on(TOPIC):
        return failed(expected, "the node answers no parameter call", causes.of_process(trace) or causes.no_spin(trace),
                      causes.last_words(trace))
    cause = causes.of_silence(trace, TOPIC, TYPE, answers=False)
    return failed(expected, f"no message on {TOPIC} to start with", cause, causes.last_words(trace))


def _not_set(expected: str, answer: SetAnswer, trace: Trace) -> Verdict:
    what = ", ".join(f"{name} to {_show(value)}" for name, value in answer.values.items())
    if not answer.answered:
        cause = causes.of_process(trace) or Cause(
            "blocked executor",
            "the node answered before, and no longer does: one of its callbacks does not come to an end",
            "let every callback return at once: no loop and no sleep in it; let a timer do what has to wait")
        return failed(expected, f"setting {what}: no answer in {ANSWER_S:g} s", cause, causes.last_words(trace))
    if "invalid type" in answer.reason:
        cause = Cause("callback returns None", "the parameter callback does not return a SetParametersResult",
                      "end the callback with: return SetParametersResult(successful=True)")
    elif "Wrong parameter type" in answer.reason:
        cause = Cause("wrong parameter type", answer.reason, "declare it with a default of the type that is set")
    elif "declared" in answer.reason:
        cause = Cause("parameter not declared", answer.reason, "declare it in __init__")
    else:
        cause = Cause("rejected", f"the node rejects a good value: \"{answer.reason}\"",
                      "let the callback return SetParametersResult(successful=True) for it")
    return failed(expected, f"setting {what}: rejected, \"{answer.reason}\"", cause)


def judge_validation(seen: Validated) -> Verdict:
    expected = f"{RATE} 0.0 and -1.0 are rejected with a reason; the value and the rate stay at {seen.base_hz} Hz"
    if not seen.rejected:
        return _not_running(seen.trace, expected)
    for answer, value in seen.rejected:
        bad = answer.values[RATE]
        if not answer.answered:
            return _not_set(expected, answer, seen.trace)
        if answer.successful:
            return failed(expected, f"{RATE} {bad} was accepted", Cause(
                "no validation", f"nothing rejects {bad}",
                "return SetParametersResult(successful=False, reason='...') for it from an on-set-parameters callback"))
        if not answer.reason.strip():
            return failed(expected, f"{bad} was rejected without a reason", Cause(
                "no reason given", "the reason is empty", "SetParametersResult(successful=False, reason='the rate must be > 0')"))
        if any(own in answer.reason for own in RCLPYS_OWN):
            return _not_set(expected, answer, seen.trace)
        if value != seen.before:
            return failed(expected, f"{bad} was rejected, but {RATE} is {_show(value)} now", Cause(
                "value changed all the same", "the value is not what it was", "change nothing when you reject"))
    if seen.rate is None or not seen.rate.agrees(seen.base_hz):
        cause = (causes.of_process(seen.trace) if seen.trace.exit else None) or Cause(
            "value changed all the same", "the rate changes although the value was rejected",
            "check the value first; touch the timer only once it is accepted")
        return failed(expected, f"after the rejection: {describe(seen.rate, seen.messages)}", cause)
    return passed(expected, f"rejected: \"{seen.rejected[0][0].reason}\"; still {seen.rate}")


def judge_timer(seen: Retimed) -> Verdict:
    expected = f"setting {RATE} changes the measured rate: {UP_HZ} Hz, then {DOWN_HZ} Hz, ±{TOLERANCE:.0%}"
    if not seen.steps:
        return _not_running(seen.trace, expected)
    for answer, rate, messages in seen.steps:
        asked = answer.values[RATE]
        if not answer.answered or not answer.successful:
            return _not_set(expected, answer, seen.trace)
        if rate is None or not rate.agrees(asked):
            return failed(expected, f"{RATE} set to {asked}: {describe(rate, messages)}", _why_timer(seen, asked, rate))
    return passed(expected, ", then ".join(str(rate) for _, rate, _ in seen.steps))


def _why_timer(seen: Retimed, asked: float, rate: Rate | None) -> Cause:
    if seen.trace.exit and (cause := causes.of_process(seen.trace)):
        return cause
    before = DEFAULT_HZ if asked == UP_HZ else UP_HZ
    if rate is not None and rate.agrees(before):
        return Cause(
            "timer not replaced",
            "the parameter changes, but the timer keeps its old period",
            "in the parameter callback: self.timer.cancel(), then self.timer = self.create_timer(1.0 / rate, ...)",
        )
    if rate is not None and rate.hz > asked:
        return Cause(
            "old timer kept",
            f"{rate.hz:.1f} Hz is more than {asked:g} Hz: an older timer publishes too",
            "cancel the old timer before you make the new one: self.destroy_timer(self.timer)",
        )
    if rate is None or rate.hz < DOWN_HZ / 2:
        return _as_period() if rate is None or rate.agrees(1 / asked) else Cause(
            "wrong rate", f"{rate.hz:.1f} Hz instead of {asked:g} Hz", "the timer's period is 1.0 / rate seconds")
    return Cause("wrong rate", f"{rate.hz:.1f} Hz instead of {asked:g} Hz", "the timer's period is 1.0 / rate seconds")


def judge_atomic(seen: Atomic) -> Verdict:
    expected = f"an atomic set of a good {PREFIX} and a bad {RATE}, in either order, changes nothing at all"
    if not seen.answers:
        return _not_running(seen.trace, expected)
    unanswered = next((answer for answer in seen.answers if not answer.answered), None)
    if unanswered is not None:
        return _not_set(expected, unanswered, seen.trace)
    if any(answer.successful for answer in seen.answers):
        return failed(expected, "the request was accepted", Cause(
            "no validation", f"{RATE} {BAD_RATES[1]} is not rejected in an atomic request",
            "check every parameter of the list before you accept"))
    if "declared" in seen.answers[0].reason:
        return _not_set(expected, seen.answers[0], seen.trace)
    changed = next((held for held in seen.values if held != seen.before), None)
    partial = "only validate in the on-set callback; apply in a post-set callback (add_post_set_parameters_callback)"
    if changed is not None or seen.shown is not None:
        now = f"a message reads \"{_text(seen.shown)}\"" if seen.shown else f"{PREFIX}, {RATE} are {changed}"
        return failed(expected, f"rejected, but {now}", Cause(
            "partial change", "the callback applies the first parameter before it looks at the second", partial))
    if seen.rate is None or not seen.rate.agrees(seen.base_hz):
        return failed(expected, f"rejected, but then {describe(seen.rate, seen.messages)}", Cause(
            "partial change", "the timer was touched although the request was rejected", partial))
    return passed(expected, f"both rejected (\"{seen.answers[0].reason}\"), nothing changed")


def judge_bad_launch(plain: Survey, seen: Sequence[Trace]) -> Verdict:
    expected = f"a start with {RATE}:=0.0 or {RATE}:=-1.0 gives a message that names {RATE}"
    ordinary = {_shape(line) for line in _naming(plain.trace)}
    for trace in seen:
        if not any(_shape(line) not in ordinary for line in _naming(trace)):
            given = f"{RATE}:={trace.parameters[RATE]}"
            found = tracebacks.last(trace)
            observed = f"with {given}: {found.raised if found else 'no message about it'}"
            cause = Cause(
                "only a traceback" if found else "no validation",
                "nobody can tell from this which parameter is wrong" if found else "the node takes the bad value silently",
                f"check it after declaring it, and log an error that names {RATE}",
            )
            return failed(expected, observed, cause, causes.last_words(trace))
    return passed(expected, "it does", [_naming(trace)[-1] for trace in seen])


def judge_shutdown(seen: Survey) -> Verdict:
    return ending.judge(seen.trace, seen.ending)


def _show(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else repr(value) if isinstance(value, str) else str(value)


CHECK = Check(
    "i2.1",
    (
        Criterion("defaults", judge_defaults, (survey,)),
        Criterion("launch-params", judge_launch, (launched,)),
        Criterion("runtime-params", judge_runtime, (switched,)),
        Criterion("validation", judge_validation, (validated,)),
        Criterion("timer", judge_timer, (retimed,)),
        Criterion("atomic", judge_atomic, (atomic,), bonus=True),
        Criterion("launch-validation", judge_bad_launch, (survey, bad_launches), bonus=True),
        Criterion("shutdown", judge_shutdown, (survey,), bonus=True),
    ),
)
