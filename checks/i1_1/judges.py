"""I1.1: the verdicts, as pure functions of the facts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from checks.i1_1 import causes as i1_1_causes
from checks.i1_1 import steps
from checks.i1_1.facts import (
    HIGHEST,
    LOWEST,
    MAX_COLLECT_S,
    MIN_VALUES,
    SUGGESTED_NAME,
    TOPIC,
    TYPE,
    CollectedValues,
    NameProbes,
    PlainStart,
    RateProbe,
    RateProbes,
    count_agreeing,
    find_agreeing_groups,
    find_inverted_probes,
    find_out_of_range,
    group_probes,
    has_known_unit,
    parameter_and_unit,
)
from tutor.judge import causes, ending, randomness
from tutor.judge.rates import TOLERANCE
from tutor.judge.rewriting.whole import with_applicable_steps
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause, Verdict, failed, passed


def _traces(*facts: PlainStart | CollectedValues | RateProbes | NameProbes) -> list[Trace]:
    """The traces behind the facts; for probes, only that of the first one."""
    runs = [each.probes[:1] if isinstance(each, RateProbes | NameProbes) else (each,) for each in facts]
    return [trace for group in runs for run in group if (trace := run.trace) is not None]


def _with_steps[**P](judge: Callable[P, Verdict]) -> Callable[P, Verdict]:
    return with_applicable_steps(judge, _traces, steps.find_any_step)


@_with_steps
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
    cause = causes.diagnose_no_messages(
        seen.trace,
        TOPIC,
        TYPE,
        answers=seen.parameters is not None,
        stuck=seen.stuck,
        step=steps.add_publisher(seen.trace),
    )
    return failed(expected, observed, cause, [*evidence, *causes.output_tail(seen.trace)])


@_with_steps
def judge_range(found: CollectedValues, more: CollectedValues) -> Verdict:
    expected = f"every value in [{LOWEST}, {HIGHEST}] °C"
    if not found.all:
        return failed(expected, "no values at all", i1_1_causes.diagnose_stopped(found.trace))
    values = (*found.all, *more.all)
    wrong = find_out_of_range(values)
    if not wrong:
        return passed(expected, f"{len(values)} values from {min(values):.2f} to {max(values):.2f} °C")
    return failed(
        expected,
        f"{len(wrong)} of {len(values)} values outside, such as {wrong[0]:g}",
        i1_1_causes.diagnose_range(wrong, values, found.trace),
        [f"data: {value!r}" for value in wrong[:5]],
    )


def judge_range_so_far(found: CollectedValues) -> Verdict | None:
    """Judge `range` by the values so far; None while a few Fahrenheit-like ones do not yet show what all look like."""
    if len(found.all) < MIN_VALUES and all(map(i1_1_causes.is_fahrenheit, found.all)):
        return None
    return judge_range(found, CollectedValues(()))


@_with_steps
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
            Cause(pattern.name, pattern.text, steps.draw_values(found.trace)),
            [f"data: {value:g}" for value in run[:8]],
        )
    longest = max(found.runs, key=len)
    if len(longest) < 3:
        return failed(
            expected, f"only {len(longest)} values in {MAX_COLLECT_S:g} s", i1_1_causes.diagnose_stopped(found.trace)
        )
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


@_with_steps
def judge_echo(seen: PlainStart) -> Verdict:
    expected = f"`ros2 topic echo {TOPIC}` shows the values"
    echo = seen.echo
    if echo is None:
        return failed(expected, "messages do not go on arriving", i1_1_causes.diagnose_stopped(seen.trace))
    # A subscription counts, too: the real echo takes the type from all that is on the topic, and refuses two.
    graph = seen.trace.graph
    found = {each.type for each in (*graph.publishers, *graph.subscriptions) if each.topic == TOPIC}
    if len(types := sorted(found.union(echo.types))) > 1:
        cause = Cause(
            "wrong type",
            f"{TOPIC} carries two types, {' and '.join(types)}; echo cannot choose",
            steps.use_one_type(seen.trace),
        )
        return failed(expected, "refused, since there is more than one type on the topic", cause)
    if echo.samples:
        return passed(
            expected,
            f"shown with {echo.qos.reliability}, {echo.qos.durability} QoS",
            [f"data: {echo.samples[0].message['data']}"],
        )
    if not echo.types:
        cause = i1_1_causes.diagnose_exception(seen.trace) or Cause(
            "no publisher", "the publisher was gone when echo looked for it", "keep it for as long as the node lives"
        )
    else:
        cause = Cause(
            "no messages",
            f"a new subscriber got nothing in {echo.limit_s:g} s ({echo.qos.reliability}, {echo.qos.durability})",
            steps.add_publisher(seen.trace)
            or "publish again and again from a timer, and set no short lifespan in the QoS",
        )
    return failed(expected, f"nothing shown in {echo.limit_s:g} s", cause)


@_with_steps
def judge_rate(found: RateProbes) -> Verdict:
    expected = f"some numeric parameter, set at start-up, sets the rate (±{TOLERANCE:.0%})"
    for group in find_agreeing_groups(found.probes):
        observed = f"{group[0].name} is read in {group[0].unit}"
        return passed(expected, observed, [str(probe) for probe in group], spins=found.spins)
    if not found.probes:
        return failed(expected, "no numeric parameter is declared", i1_1_causes.diagnose_undeclared_rate(None))
    declared = {parameter.name for parameter in found.declared or ()}

    def likelihood(group: Sequence[RateProbe]) -> tuple[bool, int, int, bool]:
        name, unit = parameter_and_unit(group[0])
        known = name in declared and has_known_unit(name)
        return known, count_agreeing(group), len(find_inverted_probes(group)), unit == "ms" and name.endswith("ms")

    nearest = max(group_probes(found.probes), key=likelihood)
    wrong = next((probe for probe in nearest if not probe.agrees), None)
    if wrong is None:
        cause = Cause(
            "wrong rate",
            f"{nearest[0].name} accepts only one rate among those that were tried",
            "let it accept any rate from 0.5 to 10 Hz",
        )
        return failed(expected, f"{nearest[0]}; no other value is allowed", cause)
    return failed(
        expected,
        str(wrong),
        i1_1_causes.diagnose_rate(nearest, wrong, found.declared),
        [str(probe) for probe in nearest],
    )


@_with_steps
def judge_name(found: NameProbes) -> Verdict:
    expected = "some string parameter, set at start-up, appears in the node's log messages"
    for probe in found.probes:
        if probe.found:
            return passed(expected, f"{probe.name}:={probe.value} is logged", [probe.found])
    probe = found.probes[0]
    if found.declared is not None and probe.name not in {parameter.name for parameter in found.declared}:
        return failed(
            expected,
            "no string parameter is declared",
            Cause(
                "parameter not declared",
                "the sensor's name cannot be set from outside",
                steps.declare_name(probe.trace, SUGGESTED_NAME),
            ),
        )
    evidence = [str(log) for log in probe.trace.logs[-5:]]
    observed = f"{probe.name}:={probe.value} is in none of {len(probe.trace.logs)} log messages"
    return failed(expected, observed, i1_1_causes.diagnose_name(found), evidence)


def judge_shutdown(seen: PlainStart) -> Verdict:
    return ending.judge_ending(seen.trace, seen.ending, shown_by="publishes")
