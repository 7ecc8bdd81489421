"""I1.1: the verdicts, as pure functions of the facts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from checks.i1_1.facts import (
    HIGHEST,
    LOWEST,
    MAX_COLLECT_S,
    MIN_VALUES,
    SUGGESTED_NAME,
    SUGGESTED_RATE,
    TOPIC,
    TYPE,
    CollectedValues,
    NameProbe,
    NameProbes,
    PlainStart,
    RateProbe,
    RateProbes,
    are_inverted,
    count_agreeing,
    find_agreeing_groups,
    find_inverted_probes,
    find_out_of_range,
    group_probes,
    has_known_unit,
    parameter_and_unit,
)
from tutor.judge import ending, randomness
from tutor.judge.rates import TOLERANCE
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Trace
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.wording import output_tail
from tutor.ros_model import Graph, Parameter

NOT_STARTED = Trace("", graph=Graph(("/node",)))
"""The run of a scenario that did not start the program, since another one had shown enough: its node, for one."""


def judge_publishes(seen: PlainStart) -> Verdict:
    expected = f"{TYPE} messages go on arriving on {TOPIC}"
    samples, began = seen.trace.samples_on(TOPIC), seen.trace.started_at
    evidence = [f"data: {sample.message['data']}" for sample in samples[:1]]
    if seen.messages_go_on:
        observed = f"{len(samples)} messages, the first {samples[0].received_at - began:.2f} s after the start"
        return passed(expected, observed, evidence)
    observed = "no such message arrived"
    if samples:
        number = f"{len(samples)} messages" if len(samples) > 1 else "one message"
        observed = f"{number} until {samples[-1].received_at - began:.1f} s after the start, then no more"
    missing = Symptom.NO_MESSAGES.seen(
        seen.trace, stuck=seen.stuck, answers=seen.parameters is not None, topic=TOPIC, type=TYPE, some=bool(samples)
    )
    return failed(expected, observed, missing, [*evidence, *output_tail(seen.trace)])


def judge_range(found: CollectedValues, more: CollectedValues) -> Verdict:
    expected = f"every value in [{LOWEST}, {HIGHEST}] °C"
    if not found.all:
        return failed(expected, "no values at all", _stopped(found.trace))
    values = (*found.all, *more.all)
    wrong = find_out_of_range(values)
    if not wrong:
        return passed(expected, f"{len(values)} values from {min(values):.2f} to {max(values):.2f} °C")
    return failed(
        expected,
        f"{len(wrong)} of {len(values)} values outside, such as {wrong[0]:g}",
        _out_of_range(wrong, values, found.trace),
        [f"data: {value!r}" for value in wrong[:5]],
    )


def _stopped(trace: Trace | None) -> Observation:
    return Symptom.NO_MESSAGES.seen(trace or NOT_STARTED, topic=TOPIC, type=TYPE, some=True)


def _is_fahrenheit(value: float) -> bool:
    """Whether a value is what a room has in degrees Fahrenheit: 60 to 90."""
    return 60 <= value <= 90


def _out_of_range(wrong: Sequence[float], values: Sequence[float], trace: Trace | None) -> Observation:
    return Symptom.WRONG_VALUES.seen(
        trace or NOT_STARTED,
        topic=TOPIC,
        wrong=tuple(wrong),
        lowest=LOWEST,
        highest=HIGHEST,
        fahrenheit=all(map(_is_fahrenheit, values)),
    )


def judge_range_so_far(found: CollectedValues) -> Verdict | None:
    """Judge `range` by the values so far; None while a few Fahrenheit-like ones do not yet show what all look like."""
    if len(found.all) < MIN_VALUES and all(map(_is_fahrenheit, found.all)):
        return None
    return judge_range(found, CollectedValues(()))


def judge_random(found: CollectedValues) -> Verdict:
    expected = "values that vary at random: not constant, not a ramp, not a short cycle"
    runs = (*found.runs, found.regular)
    patterns = [(run, pattern) for run in runs if (pattern := _find_pattern(run)) is not None]
    large_enough = sum(len(run) >= randomness.MIN_SAMPLE_SIZE for run in found.runs)
    if patterns and (any(pattern.significant for _, pattern in patterns) or len(patterns) >= large_enough):
        run, pattern = max(patterns, key=lambda each: (each[1].significant, len(each[0])))
        return failed(
            expected,
            f"{pattern.text} ({len(run)} values)",
            Symptom.WRONG_VALUES.seen(found.trace or NOT_STARTED, topic=TOPIC, pattern=pattern, drawn=run),
            [f"data: {value:g}" for value in run[:8]],
        )
    longest = max(found.runs, key=len)
    if len(longest) < 3:
        return failed(expected, f"only {len(longest)} values in {MAX_COLLECT_S:g} s", _stopped(found.trace))
    return passed(expected, f"{len(longest)} values, no pattern", [f"data: {value:g}" for value in longest[:5]])


def _find_pattern(run: Sequence[float]) -> randomness.Pattern | None:
    """Find a pattern in these values; getting stuck on one value takes precedence over any other."""
    found, stuck = randomness.find_pattern(run), _find_stuck_value(run)
    return replace(stuck, significant=found is not None and found.significant) if stuck else found


def _find_stuck_value(run: Sequence[float]) -> randomness.Pattern | None:
    """Find a run of distinct values followed by a new one that repeats for at least half of `FULL_SAMPLE_SIZE`.

    It must be new: in coarsely rounded values that are mostly one number, that number occurs earlier as well.
    """
    repeats = next((i for i, value in enumerate(reversed(run)) if value != run[-1]), len(run))
    before = run[: len(run) - repeats]
    if repeats < randomness.FULL_SAMPLE_SIZE / 2 or len(before) < 2 or len({*before, run[-1]}) <= len(before):
        return None
    return randomness.Pattern("constant value", f"the last {repeats} values are all {run[-1]:g}")


def judge_echo(seen: PlainStart) -> Verdict:
    expected = f"`ros2 topic echo {TOPIC}` shows the values"
    echo = seen.echo
    if echo is None:
        return failed(expected, "messages do not go on arriving", _stopped(seen.trace))
    # A subscription counts, too: the real echo takes the type from all that is on the topic, and refuses two.
    graph = seen.trace.graph
    found = {each.type for each in (*graph.publishers, *graph.subscriptions) if each.topic == TOPIC}
    if len(types := sorted(found.union(echo.types))) > 1:
        mixed = Symptom.NO_MESSAGES.seen(seen.trace, topic=TOPIC, type=TYPE, types=tuple(types))
        return failed(expected, "refused, since there is more than one type on the topic", mixed)
    if echo.samples:
        return passed(
            expected,
            f"shown with {echo.qos.reliability}, {echo.qos.durability} QoS",
            [f"data: {echo.samples[0].message['data']}"],
        )
    gone = not echo.types
    unheard = Symptom.NO_MESSAGES.seen(seen.trace, topic=TOPIC, type=TYPE, some=True, qos=str(echo.qos), gone=gone)
    return failed(expected, f"nothing shown in {echo.limit_s:g} s", unheard)


def judge_rate(found: RateProbes) -> Verdict:
    expected = f"some numeric parameter, set at start-up, sets the rate (±{TOLERANCE:.0%})"
    for group in find_agreeing_groups(found.probes):
        observed = f"{group[0].name} is read in {group[0].unit}"
        return passed(expected, observed, [str(probe) for probe in group], spins=found.spins)
    if not found.probes:
        undeclared = Symptom.NOT_DECLARED.seen(NOT_STARTED, **_RATE_MISSING)
        return failed(expected, "no numeric parameter is declared", undeclared)
    declared = {parameter.name for parameter in found.declared or ()}

    def likelihood(group: Sequence[RateProbe]) -> tuple[bool, int, int, bool]:
        name, unit = parameter_and_unit(group[0])
        known = name in declared and has_known_unit(name)
        return known, count_agreeing(group), len(find_inverted_probes(group)), unit == "ms" and name.endswith("ms")

    nearest = max(group_probes(found.probes), key=likelihood)
    wrong = next((probe for probe in nearest if not probe.agrees), None)
    if wrong is None:
        narrow = Symptom.REFUSED.seen(
            nearest[0].trace,
            parameter=nearest[0].name,
            says=f"{nearest[0].name} takes only one of the rates that were tried",
            do="Let it take any rate from 0.5 to 10 Hz.",
        )
        return failed(expected, f"{nearest[0]}; no other value is allowed", narrow)
    return failed(
        expected,
        str(wrong),
        _wrong_rate(nearest, wrong, found.declared),
        [str(probe) for probe in nearest],
    )


_RATE_MISSING: dict[str, Any] = {"parameter": SUGGESTED_RATE, "what": "the rate", "type": "double"}
_NAME_MISSING: dict[str, Any] = {"parameter": SUGGESTED_NAME, "what": "the sensor's name", "type": "string"}


def _wrong_rate(group: Sequence[RateProbe], wrong: RateProbe, declared: tuple[Parameter, ...] | None) -> Observation:
    """The rate differs from the one asked for; `group`: the probes that agree with each other best."""
    if declared is not None and wrong.name not in {parameter.name for parameter in declared}:
        return Symptom.NOT_DECLARED.seen(wrong.trace, **_RATE_MISSING)
    rates_hz = [probe.rate.hz for probe in group if probe.rate is not None]
    return Symptom.WRONG_RATE.seen(
        wrong.trace,
        topic=TOPIC,
        type=TYPE,
        parameter=wrong.name,
        unit=wrong.unit,
        wanted_hz=wrong.asked_hz,
        rate=wrong.rate,
        inverted=are_inverted(group),
        unchanged=len(rates_hz) > 1 and max(rates_hz) <= min(rates_hz) * (1 + TOLERANCE),
        at_start=True,
    )


def judge_name(found: NameProbes) -> Verdict:
    expected = "some string parameter, set at start-up, appears in the node's log messages"
    for probe in found.probes:
        if probe.found:
            return passed(expected, f"{probe.name}:={probe.value} is logged", [probe.found])
    probe = found.probes[0]
    if found.declared is not None and probe.name not in {parameter.name for parameter in found.declared}:
        undeclared = Symptom.NOT_DECLARED.seen(probe.trace, **_NAME_MISSING)
        return failed(expected, "no string parameter is declared", undeclared)
    evidence = [str(log) for log in probe.trace.logs[-5:]]
    observed = f"{probe.name}:={probe.value} is in none of {len(probe.trace.logs)} log messages"
    return failed(expected, observed, _not_logged(found), evidence)


def _not_logged(found: NameProbes) -> Observation:
    silent = next(
        (each.trace for each in found.probes if not each.trace.logs and not each.trace.samples_on(TOPIC)), None
    )
    if silent is not None and any(each.topic == TOPIC for each in silent.graph.publishers):
        return Symptom.NO_MESSAGES.seen(silent, answers=found.declared is not None, topic=TOPIC, type=TYPE)
    if found.declared is None and not any(_is_printed(probe) for probe in found.probes):
        return Symptom.NOT_DECLARED.seen(found.probes[0].trace, **_NAME_MISSING)
    names = {parameter.name for parameter in found.declared or ()}
    declared = [probe for probe in found.probes if probe.name in names]
    probe = next((each for each in found.probes if _is_printed(each)), (declared or found.probes)[0])
    return Symptom.NOT_LOGGED.seen(
        probe.trace,
        parameter=probe.name,
        what="the sensor's name",
        value=probe.value,
        at_end=probe.at_end,
        says=f"{probe.name} is declared, but its value is in no log message",
        do="Put the parameter's value into a message that the node logs.",
    )


def _is_printed(probe: NameProbe) -> bool:
    return any(probe.value in line.text for line in (*probe.trace.output, *probe.at_end))


def judge_shutdown(seen: PlainStart) -> Verdict:
    return ending.judge_ending(seen.trace, seen.ending, shown_by="publishes")
