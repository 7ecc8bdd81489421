"""I1.1: starts with parameters, which probe what sets the rate and what is logged as the sensor's name."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from checks.i1_1.facts import (
    FALLBACK_VALUES,
    FAST_COLLECT_S,
    FAST_HZ,
    FILE,
    PROBE_VALUES,
    SUGGESTED_NAME,
    SUGGESTED_RATE,
    TOPIC,
    TYPE,
    UNITS,
    NameProbe,
    NameProbes,
    RateProbe,
    RateProbes,
    are_inverted,
    count_agreeing,
    find_agreeing_groups,
    group_probes,
    has_known_unit,
    numeric_parameters,
    parameter_and_unit,
    possible_units,
)
from checks.i1_1.log_calls import logs_the_same_on_each_message
from checks.i1_1.scenarios import ANSWER_S, cancel, parameters, plain_start, values_of
from tutor.judge import randomness
from tutor.judge.bench import Bench, MachineTooBusy, Run
from tutor.judge.rates import measure
from tutor.judge.trace import Trace
from tutor.judge.waiting import (
    IDLE_S,
    MESSAGE_GAP_S,
    RESENT_S,
    TRIES,
    are_undisturbed,
    too_few_by_cpu_wait,
    wait_for_message,
    wait_until_seen,
    window_s,
)
from tutor.ros_model import Parameter

USUALLY_LOGGED_S = 3.0
"""Most nodes have logged their name within this time."""

LOG_DELAY_S = 0.5
"""Upper bound on the latency of a log message, apart from our own wait for a CPU."""


async def probe_fast(bench: Bench) -> RateProbe:
    """Start at the highest rate to probe, set through the skeleton's parameter name.

    If the values look suspicious, collect plenty of them here: at any other rate, that takes far longer.
    """
    return await _probe_rate(bench, SUGGESTED_RATE, "Hz", FAST_HZ, False)


async def probe_rates(bench: Bench) -> RateProbes:
    """Start once for each probe value of each parameter that may be the rate.

    The skeleton's parameter name is probed while `parameters` still runs, since most nodes keep that name.
    """

    async def probe(attempt: _Attempt) -> RateProbe:
        return await (bench.facts(probe_fast) if attempt[2] == FAST_HZ else _probe_rate(bench, *attempt))

    suggested = [(SUGGESTED_RATE, "Hz", value, False) for value in PROBE_VALUES["Hz"]]
    under_way = {attempt: asyncio.ensure_future(probe(attempt)) for attempt in suggested}
    try:
        declared = await bench.facts(parameters)
        if declared is None or any(p.name == SUGGESTED_RATE for p in declared):
            return await _probe_declared(bench, declared, under_way)
    finally:
        await cancel(under_way.values())
    return await _probe_declared(bench, declared, {})


_Attempt = tuple[str, str, float, bool]
"""A parameter's name, its unit, the value to set, and whether to pass that as an integer."""


async def _probe_declared(
    bench: Bench, declared: tuple[Parameter, ...] | None, under_way: dict[_Attempt, asyncio.Task[RateProbe]]
) -> RateProbes:
    """Probe each declared parameter, and the skeleton's name if it is not among them.

    `under_way`: the probes already running, which are used (and removed from the dict) instead of starting them again.
    """
    tried: list[RateProbe] = []

    async def attempt(plan: Iterable[_Attempt]) -> bool:
        # Stop early once all values of one parameter and unit agree, or once each parameter and unit has a probe that
        # disagrees plus another one to diagnose the cause from.
        wanted = Counter((name, unit) for name, unit, _, _ in plan)

        def decided() -> bool:
            if any(len(group) == wanted[parameter_and_unit(group[0])] for group in find_agreeing_groups(tried)):
                return True
            refuted = [group for group in group_probes(tried) if len(group) > 1 and count_agreeing(group) < len(group)]
            return wanted.keys() <= {parameter_and_unit(group[0]) for group in refuted}

        pending = {
            under_way.pop(each) if each in under_way else asyncio.ensure_future(_probe_rate(bench, *each))
            for each in plan
        }
        try:
            while pending and not decided():
                done, pending = await asyncio.wait(pending, return_when=asyncio.FIRST_COMPLETED)
                tried.extend(task.result() for task in done)
        finally:
            await cancel(pending)
        return bool(find_agreeing_groups(tried))

    numeric = numeric_parameters(declared or ())
    with_known_unit = [parameter for parameter in numeric if has_known_unit(parameter.name)]
    for group in (with_known_unit, *([other] for other in numeric if other not in with_known_unit)):
        if await attempt(list(_plan_attempts(group))):
            return RateProbes(declared, tuple(tried))
        # One that sets the rate to the reciprocal of what its name says leaves no room for another that sets it right.
        inverted = any(are_inverted(each, min_measured=2) for each in group_probes(tried))
        if group is with_known_unit and inverted:
            return RateProbes(declared, tuple(tried))
    if not any(p.name == SUGGESTED_RATE for p in numeric) and (await bench.facts(plain_start)).messages_go_on:
        # The node may answer no parameter call, or accept parameters that it does not declare.
        if declared is not None:
            fast = await bench.facts(probe_fast)
            if not fast.agrees and not _refused_a_double(fast.trace):
                return RateProbes(declared, (*tried, fast))  # it does not, or not for this name
        suggested = [(SUGGESTED_RATE, "Hz", value, False) for value in PROBE_VALUES["Hz"]]
        if not await attempt(suggested) and any(_refused_a_double(probe.trace) for probe in tried):
            tried = [probe for probe in tried if probe.name != SUGGESTED_RATE]
            await attempt([(SUGGESTED_RATE, "Hz", value, True) for value in PROBE_VALUES["Hz"] if value >= 1])
    return RateProbes(declared, tuple(tried))


async def probe_names(bench: Bench) -> NameProbes:
    """Start once for each string parameter, set to a value that nothing else would log, until one is logged.

    The skeleton's parameter name is probed while `parameters` still runs: it is probed in any case, since the node may
    answer no call, or accept parameters that it does not declare.
    """
    known: set[str] = set()

    async def probe(number: int, name: str) -> NameProbe:
        value = f"probe_{number}_kx7"
        async with bench.start(FILE, parameters={name: value}, watch={TOPIC: TYPE}, expected_s=0.5) as run:
            bench.report_progress(0.3, f"{name}:={value}, reading its log")

            def contains_value(text: str) -> bool:
                # `name:=value` counts only for a declared parameter: otherwise it may be the logged command line.
                return value in (text if name in known else text.replace(f":={value}", ""))

            def logged() -> str:
                return next((str(log) for log in run.logs if contains_value(str(log).casefold())), "")

            repeats = logs_the_same_on_each_message(run.trace().sources)
            since, waited_s = run.now(), run.our_cpu_wait_s()

            def has_published(messages: int, *, for_s: float = LOG_DELAY_S) -> bool:
                """Whether it has published this many messages, and the log of the last one must have arrived."""
                samples, delay_s = run.samples_on(TOPIC), for_s + run.our_cpu_wait_s() - waited_s
                return len(samples) >= messages and run.now() >= samples[messages - 1].received_at + delay_s

            def is_decided() -> bool:
                """Whether the name is logged, or never will be."""
                if logged():
                    return True
                # Without any log message, it may be that the first ones were lost, and are resent later.
                return repeats and (has_published(2) if run.logs else has_published(2, for_s=RESENT_S))

            async def wait(seen: Callable[[], bool], limit_s: float) -> None:
                await wait_until_seen(run, seen, promised=lambda: True, message_gap_s=limit_s, idle_s=IDLE_S)

            await wait(lambda: is_decided() or has_published(3), USUALLY_LOGGED_S)
            declared = await bench.facts(parameters)
            if not is_decided():
                plain = asyncio.ensure_future(bench.facts(plain_start))

                def is_over() -> bool:
                    stuck = plain.done() and plain.exception() is None and plain.result().stuck_for_ever
                    return stuck or is_decided()

                try:
                    await wait(lambda: is_over() or has_published(3), MESSAGE_GAP_S - (run.now() - since))
                    if not is_over() and not await _ignores(run, name, declared):
                        # Many nodes log every tenth message, which takes 10 s at 1 Hz, from the first one on.
                        began = run.samples_on(TOPIC)[0].received_at if run.samples_on(TOPIC) else since
                        await wait(is_over, MESSAGE_GAP_S - (run.now() - began))
                finally:
                    await cancel([plain])
            found, trace = logged(), run.trace()
            ended = await run.interrupt() if not found else None
            return NameProbe(name, value, found, trace, ended.output if ended else ())

    probes: list[NameProbe] = []
    pending = {asyncio.ensure_future(probe(0, SUGGESTED_NAME))}
    try:
        declared = await bench.facts(parameters)
        known.update(p.name for p in declared or ())
        others = [p.name for p in declared or () if p.type == "string" and p.name != SUGGESTED_NAME]
        pending.update(asyncio.ensure_future(probe(number, name)) for number, name in enumerate(others, start=1))
        while pending and not any(each.found for each in probes):  # one that is logged is enough
            done, pending = await asyncio.wait(pending, return_when=asyncio.FIRST_COMPLETED)
            probes.extend(task.result() for task in done)
    finally:
        await cancel(pending)
    return NameProbes(declared, tuple(sorted(probes, key=lambda each: each.name not in known)))  # declared ones first


async def _ignores(run: Run, name: str, declared: tuple[Parameter, ...] | None) -> bool:
    """Whether the node has not declared this parameter, neither by itself nor because it was given at start-up."""
    if declared is None or any(parameter.name == name for parameter in declared):
        return False
    given = await run.parameters(ANSWER_S)
    return given is not None and all(parameter.name != name for parameter in given)


async def _probe_rate(bench: Bench, name: str, unit: str, value: float, as_integer: bool) -> RateProbe:
    asked_hz = UNITS[unit](value)
    window = window_s(asked_hz)
    given, expected_s = {name: int(value) if as_integer else value}, 1 / asked_hz + window
    async with bench.start(FILE, parameters=given, watch={TOPIC: TYPE}, expected_s=expected_s) as run:
        bench.report_progress(0.2, f"{name}:={value:g}, measuring the rate")

        def measured() -> RateProbe:
            # The first gap may be irregular, for example if the node publishes once right at start-up.
            samples = run.samples_on(TOPIC)
            overall, tail = measure(samples), measure(samples[1:])
            rate = tail if tail and tail.covers(window) and tail.agrees_with(asked_hz) else overall
            return RateProbe(name, unit, value, rate, len(samples), run.trace())

        def decided(min_s: float) -> bool:
            rate = measure(run.samples_on(TOPIC))
            if rate is None:
                return False
            # The window of a slow rate is long: far too many messages show well before its end.
            far_above = asked_hz < 1 and rate.is_far_above(asked_hz, window)
            return far_above or rate.span_s >= 0.95 * min_s or (rate.samples > 50 and rate.hz > 20)

        if not await wait_for_message(run, TOPIC, TYPE):
            return measured()
        cpu_wait_s, since = run.node_cpu_wait_s(), run.now()
        for stretch in range(1, TRIES + 2):
            await run.until(lambda min_s=stretch * window: decided(min_s), window + 1 / asked_hz + 1)  # type: ignore[misc]
            probe = measured()
            lost_s, elapsed_s = run.node_cpu_wait_s() - cpu_wait_s, run.now() - since
            ended = run.exit is not None
            if (
                probe.agrees
                or ended
                or are_undisturbed(run.samples_on(TOPIC)[1:], cpu_wait_s=lost_s, elapsed_s=elapsed_s)
                or (probe.rate is not None and probe.rate.is_far_above(asked_hz, window))
                or (
                    stretch > 1
                    and not too_few_by_cpu_wait(probe.messages, asked_hz, cpu_wait_s=lost_s, elapsed_s=elapsed_s)
                )
            ):
                break
        else:
            raise MachineTooBusy("this machine is too busy to measure a rate")
        bench.report_progress(1.0, f"{name}:={value:g} measured")
        if not probe.agrees or asked_hz != FAST_HZ:
            return probe
        if randomness.needs_more_values(values := values_of(run)) or randomness.are_coarse(values):
            await run.until(lambda: len(values_of(run)) >= randomness.FULL_SAMPLE_SIZE, FAST_COLLECT_S)
            return replace(probe, trace=run.trace())
        return probe


def _plan_attempts(group: Sequence[Parameter]) -> Iterable[_Attempt]:
    for parameter in group:
        as_integer = parameter.type == "integer"
        low, high = parameter.minimum, parameter.maximum
        for unit in possible_units(parameter.name):
            allowed = [
                value
                for value in (*PROBE_VALUES[unit], *FALLBACK_VALUES[unit])
                if (not as_integer or value == int(value))
                and (low is None or low <= value)
                and (high is None or value <= high)
            ]
            for value in allowed[: len(PROBE_VALUES[unit])]:
                yield parameter.name, unit, value, as_integer


def _refused_a_double(trace: Trace) -> bool:
    return any("InvalidParameterType" in line.text for line in trace.output)
