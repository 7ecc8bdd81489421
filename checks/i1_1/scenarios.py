"""I1.1: what is done to the node."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

from checks.i1_1.facts import (
    ECHO_S,
    FAST_HZ,
    FILE,
    LEAST_S,
    LEAST_VALUES,
    LISTEN_S,
    MORE_S,
    SPARE_VALUES,
    SUGGESTED_NAME,
    SUGGESTED_RATE,
    TOPIC,
    TYPE,
    UNITS,
    VALUES,
    CollectedValues,
    NameProbe,
    NameProbes,
    PlainStart,
    RateProbe,
    RateProbes,
    agreeing_groups,
    count_agreeing,
    group_probes,
    numeric_parameters,
    out_of_range,
    parameter_and_unit,
    units,
)
from tutor.judge import randomness
from tutor.judge.bench import Bench, MachineTooBusy, Run
from tutor.judge.ending import repeat_if_doubtful
from tutor.judge.rates import measure
from tutor.judge.trace import Trace
from tutor.judge.waiting import (
    IDLE_S,
    RESENT_S,
    START_S,
    TRIES,
    find_stuck_frames,
    too_few_by_cpu_wait,
    wait_for_message,
    wait_until_seen,
    window_s,
)
from tutor.ros_model import Parameter


@repeat_if_doubtful
async def plain_start(bench: Bench) -> PlainStart:
    """Start it plainly: does it publish, does echo show it, does Ctrl+C end it cleanly?"""
    async with bench.start(FILE, watch={TOPIC: TYPE}, expected_s=7.0) as run:  # first: much is told by it alone
        bench.report_progress(0.1, f"waiting for the first message on {TOPIC}")
        echo = None
        if await wait_for_message(run, TOPIC, TYPE):
            bench.report_progress(0.5, "watching as `ros2 topic echo` does")
            echo = await run.echo(TOPIC, samples=1, limit_s=ECHO_S)
        parameters = await run.parameters(2.0)
        trace = run.trace()
        bench.report_progress(0.8, "pressing Ctrl+C")
        ended = await run.interrupt() if run.exit is None else None
    silent = not trace.samples_on(TOPIC) and parameters is None and trace.exit is None and bool(trace.graph.nodes)
    return PlainStart(trace, parameters, echo, ended, await find_stuck_frames(bench, FILE) if silent else ())


async def collect_values(bench: Bench) -> CollectedValues:
    """Collect values from two plain starts; more of them where they look suspicious.

    Where another start, at a higher rate, has shown a pattern, nothing is to be gained from more.
    """
    seen: dict[Run, int] = {}
    fast = asyncio.ensure_future(_regular_values(bench))

    def enough(run: Run) -> bool:
        mine = _data(run)
        if len(mine) > seen.get(run, 0) and out_of_range(mine):
            bench.report_facts(CollectedValues((tuple(mine),), run.trace()))
        seen[run] = len(mine)
        others = {value for other in seen if other is not run for value in _data(other)}
        bench.report_progress(min(len(mine) / randomness.MIN_SAMPLE_SIZE, 1), f"{len(mine)} temperatures so far")
        # The same values in both starts may be a fixed list: only its second round would tell.
        doubtful = randomness.needs_more_values(mine) or len(others.intersection(mine)) > len(mine) / 2
        told = doubtful and fast.done() and bool(fast.result())
        return (
            (told and len(mine) >= LEAST_VALUES)
            or len(mine) >= randomness.FULL_SAMPLE_SIZE
            or (not doubtful and run.now() >= run.samples_on(TOPIC)[0].source_time + LEAST_S)
        )

    try:
        runs = await asyncio.gather(_collect(bench, enough), _collect(bench, enough))
        fast_values = fast.result() if fast.done() else ()
    finally:
        await _cancel([fast])
    return CollectedValues(tuple(values for values, _ in runs), runs[0][1], fast_values)


async def _regular_values(bench: Bench) -> tuple[float, ...]:
    """The values of the start at the highest rate, where these are enough to show that they are not random."""
    with suppress(MachineTooBusy):
        probe = await bench.facts(probe_fast)
        values = tuple(_data(probe.trace))
        pattern = randomness.find_pattern(values) if len(values) >= randomness.FULL_SAMPLE_SIZE else None
        if probe.agrees and pattern is not None and pattern.significant:
            return values
    return ()


async def collect_more_values(bench: Bench) -> CollectedValues:
    """The values of the other plain start; plenty from two more if those of a start with a parameter are out of range.

    What is out of range with a parameter set may be so on purpose: it only says where to look again.
    """
    plain = tuple(_data((await bench.facts(plain_start)).trace))
    probed: list[float] = []
    if not out_of_range((*plain, *(await bench.facts(collect_values)).all)):
        with suppress(MachineTooBusy):
            probed = [value for probe in (await bench.facts(probe_rates)).probes for value in _data(probe.trace)]
    if not out_of_range(probed):
        return CollectedValues((plain,))
    bench.report_progress(0.6, "listening longer: a start with a parameter gave a temperature that is out of range")

    def enough(run: Run) -> bool:
        return len(_data(run)) >= randomness.FULL_SAMPLE_SIZE or bool(out_of_range(_data(run)))

    runs = await asyncio.gather(_collect(bench, enough), _collect(bench, enough))
    return CollectedValues((plain, *(values for values, _ in runs)), runs[0][1])


async def _collect(bench: Bench, enough: Callable[[Run], bool]) -> tuple[tuple[float, ...], Trace]:
    """The values of one plain start, and its trace."""
    async with bench.start(FILE, watch={TOPIC: TYPE}, expected_s=1 + LEAST_S) as run:
        if await wait_for_message(run, TOPIC, TYPE):
            await run.until(lambda: enough(run), LISTEN_S)
        return tuple(_data(run)), run.trace()


def _data(seen: Run | Trace) -> list[float]:
    return [sample.message["data"] for sample in seen.samples_on(TOPIC)]


async def parameters(bench: Bench) -> tuple[Parameter, ...] | None:
    """Which parameters does it declare? None where it never answers."""
    async with bench.start(FILE, watch={TOPIC: TYPE}, expected_s=5.0) as run:  # the rates wait for it
        bench.report_progress(0.1, "asking for its parameters")
        if not await run.until(lambda: bool(run.graph.parameter_nodes), START_S, idle_s=RESENT_S):
            return None
        declared = await run.parameters(4.0)
        if declared is not None and not numeric_parameters(declared):
            await wait_for_message(run, TOPIC, TYPE)  # it may declare them late
            declared = await run.parameters(4.0)
        return declared


async def probe_fast(bench: Bench) -> RateProbe:
    """Start it at the highest rate that is tried, by the name that the skeleton suggests.

    Where its values look suspicious, it is listened to until they are plenty: it takes far longer at any other rate.
    """
    return await _probe_rate(bench, SUGGESTED_RATE, "Hz", FAST_HZ, False)


async def probe_rates(bench: Bench) -> RateProbes:
    """Start it once for each value of each parameter that may be the rate.

    The name that the skeleton suggests is tried while the node is asked which parameters it has: most have that one.
    """

    async def probe(attempt: _Attempt) -> RateProbe:
        return await (bench.facts(probe_fast) if attempt[2] == FAST_HZ else _probe_rate(bench, *attempt))

    suggested = [(SUGGESTED_RATE, "Hz", value, False) for value in VALUES["Hz"]]
    begun = {each: asyncio.ensure_future(probe(each)) for each in suggested}
    try:
        declared = await bench.facts(parameters)
        if any(p.name == SUGGESTED_RATE for p in declared or ()):
            return await _probe_declared(bench, declared, begun)
    finally:
        await _cancel(begun.values())
    return await _probe_declared(bench, declared, {})


_Attempt = tuple[str, str, float, bool]
"""A parameter, the unit that it is read in, its value, and whether that is given as an integer."""


async def _probe_declared(
    bench: Bench, declared: tuple[Parameter, ...] | None, begun: dict[_Attempt, asyncio.Task[RateProbe]]
) -> RateProbes:
    """Start it for each parameter that it declares, or for the suggested one; `begun` are the starts under way."""
    tried: list[RateProbe] = []

    async def attempt(plan: Iterable[_Attempt]) -> bool:
        # As soon as every value of one parameter and unit agrees, the others need not be waited for; nor when each
        # parameter and unit has one that does not, and another one, for the cause.
        wanted = Counter((name, unit) for name, unit, _, _ in plan)

        def decided() -> bool:
            if any(len(group) == wanted[parameter_and_unit(group[0])] for group in agreeing_groups(tried)):
                return True
            refuted = [group for group in group_probes(tried) if len(group) > 1 and count_agreeing(group) < len(group)]
            return wanted.keys() <= {parameter_and_unit(group[0]) for group in refuted}

        pending = {
            begun.pop(each) if each in begun else asyncio.ensure_future(_probe_rate(bench, *each)) for each in plan
        }
        try:
            while pending and not decided():
                done, pending = await asyncio.wait(pending, return_when=asyncio.FIRST_COMPLETED)
                tried.extend(task.result() for task in done)
        finally:
            await _cancel(pending)
        return bool(agreeing_groups(tried))

    numeric = numeric_parameters(declared or ())
    telling = [parameter for parameter in numeric if len(units(parameter.name)) < len(UNITS)]
    for group in (telling, *([other] for other in numeric if other not in telling)):
        if await attempt(list(_plan(group))):
            return RateProbes(declared, tuple(tried))
    if not any(p.name == SUGGESTED_RATE for p in numeric) and (await bench.facts(plain_start)).trace.samples_on(TOPIC):
        # It may answer nothing, or take parameters that it does not declare.
        suggested = [(SUGGESTED_RATE, "Hz", value, False) for value in VALUES["Hz"]]
        if not await attempt(suggested) and any(_refused_a_double(probe.trace) for probe in tried):
            tried = [probe for probe in tried if probe.name != SUGGESTED_RATE]
            await attempt([(SUGGESTED_RATE, "Hz", value, True) for value in VALUES["Hz"] if value >= 1])
    return RateProbes(declared, tuple(tried))


async def _cancel(tasks: Collection[asyncio.Task[Any]]) -> None:
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)


async def probe_names(bench: Bench) -> NameProbes:
    """Start it once for each string parameter, with a value that nothing else would log."""
    declared = await bench.facts(parameters)
    known = {p.name for p in declared or ()}
    wanted = [p.name for p in declared or () if p.type == "string"]
    if SUGGESTED_NAME not in wanted:
        wanted.append(SUGGESTED_NAME)  # it may answer nothing, or take parameters that it does not declare

    async def probe(number: int, name: str) -> NameProbe:
        value = f"probe_{number}_kx7"
        async with bench.start(FILE, parameters={name: value}, watch={TOPIC: TYPE}, expected_s=0.5) as run:
            bench.report_progress(0.3, f"{name}:={value}, reading its log")

            def bears(text: str) -> bool:
                # A node that logs the command line has no parameter yet; one that has declared one may write it like
                # that.
                return value in (text if name in known else text.replace(f":={value}", ""))

            def logged() -> str:
                return next((str(log) for log in run.logs if bears(str(log).casefold())), "")

            await wait_until_seen(run, lambda: bool(logged()), promised=lambda: True, idle_s=IDLE_S)
            found, trace = logged(), run.trace()
            at_end = (await run.interrupt()).output if not found and run.exit is None else ()
            return NameProbe(name, value, found, trace, at_end)

    return NameProbes(declared, tuple(await asyncio.gather(*(probe(i, name) for i, name in enumerate(wanted)))))


async def _probe_rate(bench: Bench, name: str, unit: str, value: float, whole: bool) -> RateProbe:
    asked_hz = UNITS[unit](value)
    window = window_s(asked_hz)
    given, expected_s = {name: int(value) if whole else value}, 1 / asked_hz + window
    async with bench.start(FILE, parameters=given, watch={TOPIC: TYPE}, expected_s=expected_s) as run:
        bench.report_progress(0.2, f"{name}:={value:g}, measuring the rate")

        def measured() -> RateProbe:
            # The first message may come at once and the second a period later, or the other way round.
            samples = run.samples_on(TOPIC)
            whole_of_it, tail = measure(samples), measure(samples[1:])
            rate = tail if tail and tail.covers(window) and tail.agrees(asked_hz) else whole_of_it
            return RateProbe(name, unit, value, rate, len(samples), run.trace())

        def decided(least_s: float) -> bool:
            rate = measure(run.samples_on(TOPIC))
            if rate is None:
                return False
            # Of a slow rate, the window is so long that far too many messages are told in less of it.
            far_above = asked_hz < 1 and rate.is_far_above(asked_hz, window)
            return far_above or rate.span_s >= 0.95 * least_s or (rate.samples > 50 and rate.hz > 20)

        if not await wait_for_message(run, TOPIC, TYPE):
            return measured()
        cpu_wait_s, since = run.node_cpu_wait_s(), run.now()
        for stretch in range(1, TRIES + 2):
            await run.until(lambda least_s=stretch * window: decided(least_s), window + 1 / asked_hz + 1)  # type: ignore[misc]
            probe = measured()
            lost_s, of_s = run.node_cpu_wait_s() - cpu_wait_s, run.now() - since
            ended = run.exit is not None
            if (
                probe.agrees
                or ended
                or (probe.rate is not None and probe.rate.is_far_above(asked_hz, window))
                or (stretch > 1 and not too_few_by_cpu_wait(probe.messages, asked_hz, cpu_wait_s=lost_s, of_s=of_s))
            ):
                break
        else:
            raise MachineTooBusy("this machine is too busy to measure a rate")
        bench.report_progress(1.0, f"{name}:={value:g} measured")
        if probe.agrees and asked_hz == FAST_HZ and randomness.needs_more_values(_data(run)):
            await run.until(lambda: len(_data(run)) >= randomness.FULL_SAMPLE_SIZE, MORE_S)
            return replace(probe, trace=run.trace())
        return probe


def _plan(group: Sequence[Parameter]) -> Iterable[_Attempt]:
    for parameter in group:
        whole = parameter.type == "integer"
        low, high = parameter.minimum, parameter.maximum
        for unit in units(parameter.name):
            allowed = [
                value
                for value in (*VALUES[unit], *SPARE_VALUES[unit])
                if (not whole or value == int(value))
                and (low is None or low <= value)
                and (high is None or value <= high)
            ]
            for value in allowed[: len(VALUES[unit])]:
                yield parameter.name, unit, value, whole


def _refused_a_double(trace: Trace) -> bool:
    return any("InvalidParameterType" in line.text for line in trace.output)
