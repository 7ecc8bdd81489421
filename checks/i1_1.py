"""I1.1 Sensor Publisher: random temperatures on /sensor/temperature, at a configurable rate, logged under a name."""

from __future__ import annotations

import asyncio
import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from tutor.judge import causes, ending, randomness
from tutor.judge.bench import Bench, Run
from tutor.judge.check import Check, Criterion
from tutor.judge.rates import TOLERANCE, Rate, describe, measure
from tutor.judge.trace import Echo, Ending, Parameter, Trace
from tutor.judge.verdict import Cause, Verdict, failed, passed
from tutor.judge.waiting import START_S, appears, first_message, window_s

FILE = "temperature_publisher.py"
TOPIC = "/sensor/temperature"
TYPE = "std_msgs/msg/Float64"
LOWEST, HIGHEST = 20.0, 30.0

LISTEN_S = 14.0
"""Values are collected for at most this long after the first one."""

SUGGESTED_RATE, SUGGESTED_NAME = "publish_rate", "sensor_name"
"""The names that are tried where the node never answers a parameter call."""

UNITS = {"Hz": lambda value: value, "s": lambda value: 1 / value, "ms": lambda value: 1000 / value}
"""How a numeric parameter may be read: from its value to the rate in Hz that it asks for."""

VALUES = {"Hz": (2.0, 8.0, 0.5), "s": (0.5, 0.125, 2.0), "ms": (500.0, 125.0, 2000.0)}
SPARE_VALUES = {"Hz": (5.0, 1.0, 3.0, 10.0), "s": (1.0, 0.2, 0.4), "ms": (200.0, 1000.0, 400.0)}
"""Tried instead where the parameter's type or range does not allow the first ones."""


@dataclass(frozen=True)
class Survey:
    trace: Trace
    parameters: tuple[Parameter, ...] | None
    echo: Echo | None
    ending: Ending | None


@dataclass(frozen=True)
class Values:
    """The values of each of several starts without parameters."""

    runs: tuple[tuple[float, ...], ...]


@dataclass(frozen=True)
class RateProbe:
    name: str
    unit: str
    value: float
    rate: Rate | None
    messages: int
    trace: Trace

    @property
    def asked_hz(self) -> float:
        return UNITS[self.unit](self.value)

    @property
    def agrees(self) -> bool:
        return self.rate is not None and self.rate.agrees(self.asked_hz)

    def __str__(self) -> str:
        return f"{self.name}:={self.value:g} asks for {self.asked_hz:g} Hz, measured {describe(self.rate, self.messages)}"


@dataclass(frozen=True)
class Rates:
    declared: tuple[Parameter, ...] | None
    probes: tuple[RateProbe, ...]


@dataclass(frozen=True)
class NameProbe:
    name: str
    value: str
    found: str
    trace: Trace


@dataclass(frozen=True)
class Names:
    declared: tuple[Parameter, ...] | None
    probes: tuple[NameProbe, ...]


# --- scenarios ---------------------------------------------------------------------------------------------------------


async def survey(bench: Bench) -> Survey:
    """Start it plainly: does it publish, does echo show it, does Ctrl+C end it cleanly?"""
    async with bench.start(FILE, watch={TOPIC: TYPE}) as run:
        bench.doing(0.1, f"waiting for the first message on {TOPIC}")
        echo = None
        if await first_message(run, TOPIC, TYPE):
            bench.doing(0.5, "watching as `ros2 topic echo` does")
            echo = await run.echo(TOPIC, samples=1, limit_s=LISTEN_S)
        parameters = await run.parameters(2.0)
        trace = run.trace()
        bench.doing(0.8, "pressing Ctrl+C")
        ended = await run.interrupt() if run.exit is None else None
        return Survey(trace, parameters, echo, ended)


async def values(bench: Bench) -> Values:
    """Collect values from two plain starts; more of them where they look suspicious."""

    async def collect(number: int) -> tuple[Run, list[float]]:
        async with bench.start(FILE, watch={TOPIC: TYPE}) as run:
            seen[number] = run
            if await first_message(run, TOPIC, TYPE):
                await run.until(lambda: enough(run), LISTEN_S)
            return run, data(run)

    def data(run: Run) -> list[float]:
        return [sample.message["data"] for sample in run.on(TOPIC)]

    def enough(run: Run) -> bool:
        mine = data(run)
        others = {value for other in seen.values() if other is not run for value in data(other)}
        bench.doing(min(len(mine) / randomness.ENOUGH, 1), f"{len(mine)} temperatures so far")
        # The same values in both starts may be a fixed list: only its second round would tell.
        doubtful = randomness.suspicious(mine) or len(others.intersection(mine)) > len(mine) / 2
        return len(mine) >= (randomness.PLENTY if doubtful else randomness.ENOUGH)

    seen: dict[int, Run] = {}
    collected = await asyncio.gather(collect(0), collect(1))
    return Values(tuple(tuple(mine) for _, mine in collected))


async def parameters(bench: Bench) -> tuple[Parameter, ...] | None:
    """Which parameters does it declare? None where it never answers."""
    async with bench.start(FILE, watch={TOPIC: TYPE}) as run:
        bench.doing(0.1, "asking for its parameters")
        if not await run.until(lambda: any(s.name.endswith("/list_parameters") for s in run.graph.services), START_S):
            return None
        declared = await run.parameters(4.0)
        if declared is not None and not _numeric(declared):
            await first_message(run, TOPIC, TYPE)  # it may declare them late
            declared = await run.parameters(4.0)
        return declared


async def rates(bench: Bench) -> Rates:
    """Start it once for each value of each parameter that may be the rate."""
    declared = await bench.facts(parameters)
    tried: list[RateProbe] = []

    async def attempt(plan: Iterable[tuple[str, str, float, bool]]) -> bool:
        # As soon as every value of one parameter and unit agrees, the others need not be waited for.
        wanted = Counter((name, unit) for name, unit, _, _ in plan)
        pending = {asyncio.ensure_future(_probe_rate(bench, *each)) for each in plan}
        try:
            while pending and not any(len(group) == wanted[_key(group[0])] for group in _agreeing(tried)):
                done, pending = await asyncio.wait(pending, return_when=asyncio.FIRST_COMPLETED)
                tried.extend(task.result() for task in done)
        finally:
            for task in pending:
                task.cancel()
            await asyncio.gather(*pending, return_exceptions=True)
        return bool(_agreeing(tried))

    numeric = _numeric(declared or ())
    telling = [parameter for parameter in numeric if len(_units(parameter.name)) < len(UNITS)]
    for group in (telling, *([other] for other in numeric if other not in telling)):
        if await attempt(list(_plan(group))):
            return Rates(declared, tuple(tried))
    if not any(p.name == SUGGESTED_RATE for p in numeric) and (await bench.facts(survey)).trace.on(TOPIC):
        # It may answer nothing, or take parameters that it does not declare.
        suggested = [(SUGGESTED_RATE, "Hz", value, False) for value in VALUES["Hz"]]
        if not await attempt(suggested) and any(_refused_a_double(probe.trace) for probe in tried):
            tried = [probe for probe in tried if probe.name != SUGGESTED_RATE]
            await attempt([(SUGGESTED_RATE, "Hz", value, True) for value in VALUES["Hz"] if value >= 1])
    return Rates(declared, tuple(tried))


async def names(bench: Bench) -> Names:
    """Start it once for each string parameter, with a value that nothing else would log."""
    declared = await bench.facts(parameters)
    wanted = [p.name for p in declared or () if p.type == "string"]
    if SUGGESTED_NAME not in wanted:
        wanted.append(SUGGESTED_NAME)  # it may answer nothing, or take parameters that it does not declare

    async def probe(number: int, name: str) -> NameProbe:
        value = f"probe_{number}_kx7"
        async with bench.start(FILE, parameters={name: value}, watch={TOPIC: TYPE}) as run:
            bench.doing(0.3, f"{name}:={value}, reading its log")

            def logged() -> str:
                return next((str(log) for log in run.logs if value in str(log).casefold()), "")

            await appears(run, lambda: bool(logged()), promised=lambda: True)
            return NameProbe(name, value, logged(), run.trace())

    return Names(declared, tuple(await asyncio.gather(*(probe(i, name) for i, name in enumerate(wanted)))))


async def _probe_rate(bench: Bench, name: str, unit: str, value: float, whole: bool) -> RateProbe:
    asked_hz = UNITS[unit](value)
    window = window_s(asked_hz)
    async with bench.start(FILE, parameters={name: int(value) if whole else value}, watch={TOPIC: TYPE}) as run:
        bench.doing(0.2, f"{name}:={value:g}, measuring the rate")

        def heard() -> RateProbe:
            # The first message may come at once and the second a period later, or the other way round.
            samples = run.on(TOPIC)
            samples = samples[1:] if len(samples) > 3 else samples
            return RateProbe(name, unit, value, measure(samples), len(samples), run.trace())

        def decided(least_s: float) -> bool:
            rate = measure(run.on(TOPIC))
            return rate is not None and (rate.span_s >= least_s or (rate.samples > 50 and rate.hz > 20))

        if await first_message(run, TOPIC, TYPE):
            await run.until(lambda: decided(window), window + 1 / asked_hz + 1)
            if not heard().agrees:
                await run.until(lambda: decided(2 * window), window + 1 / asked_hz + 1)
        bench.doing(1.0, f"{name}:={value:g} measured")
        return heard()


def _plan(group: Sequence[Parameter]) -> Iterable[tuple[str, str, float, bool]]:
    for parameter in group:
        whole = parameter.type == "integer"
        low, high = parameter.minimum, parameter.maximum
        for unit in _units(parameter.name):
            allowed = [
                value
                for value in (*VALUES[unit], *SPARE_VALUES[unit])
                if (not whole or value == int(value)) and (low is None or low <= value) and (high is None or value <= high)
            ]
            for value in allowed[: len(VALUES[unit])]:
                yield parameter.name, unit, value, whole


def _units(name: str) -> tuple[str, ...]:
    """What a parameter's name says of its unit; all of them where it says nothing, or two things."""
    lower = name.casefold()
    as_rate = any(word in lower for word in ("rate", "hz", "freq"))
    as_period = any(word in lower for word in ("period", "interval"))
    if as_rate and not as_period:
        return ("Hz",)
    if as_period and not as_rate:
        return ("s", "ms")
    return ("Hz", "s", "ms")


def _numeric(declared: Iterable[Parameter]) -> list[Parameter]:
    return [p for p in declared if p.type in ("integer", "double") and not p.name.startswith("qos_overrides")]


def _key(probe: RateProbe) -> tuple[str, str]:
    return probe.name, probe.unit


def _groups(probes: Iterable[RateProbe]) -> list[list[RateProbe]]:
    """The probes of each parameter and unit."""
    groups: dict[tuple[str, str], list[RateProbe]] = {}
    for probe in probes:
        groups.setdefault(_key(probe), []).append(probe)
    return list(groups.values())


def _agreeing(probes: Iterable[RateProbe]) -> list[list[RateProbe]]:
    """The groups of which every probe agrees, two different rates at least: one may be right by chance."""
    return [group for group in _groups(probes) if len(group) > 1 and all(probe.agrees for probe in group)]


def _agree(group: Iterable[RateProbe]) -> int:
    return sum(probe.agrees for probe in group)


def _swapped(group: Iterable[RateProbe]) -> list[RateProbe]:
    """The probes that show the period where the rate was asked for, or the other way round."""
    return [probe for probe in group if probe.rate is not None and probe.rate.agrees(1 / probe.asked_hz)]


def _refused_a_double(trace: Trace) -> bool:
    return any("InvalidParameterType" in line.text for line in trace.output)


# --- judges ------------------------------------------------------------------------------------------------------------


def judge_publishes(seen: Survey) -> Verdict:
    expected = f"{TYPE} messages on {TOPIC}"
    samples = seen.trace.on(TOPIC)
    if samples:
        return passed(expected, f"{len(samples)} messages, the first {samples[0].received_at - seen.trace.started_at:.2f} s "
                                f"after the start", [f"data: {samples[0].message['data']}"])
    answers = seen.parameters is not None
    cause = causes.of_silence(seen.trace, TOPIC, TYPE, answers=answers)
    return failed(expected, "no such message", cause, causes.last_words(seen.trace))


def judge_range(found: Values) -> Verdict:
    expected = f"every value in [{LOWEST}, {HIGHEST}] °C"
    all_values = [value for run in found.runs for value in run]
    outside = [value for value in all_values if not LOWEST <= value <= HIGHEST]
    if not outside:
        return passed(expected, f"{len(all_values)} values from {min(all_values):.2f} to {max(all_values):.2f} °C")
    return failed(
        expected,
        f"{len(outside)} of {len(all_values)} values outside, such as {outside[0]:g}",
        _why_outside(outside),
        [f"data: {value!r}" for value in outside[:5]],
    )


def _why_outside(outside: Sequence[float]) -> Cause:
    if all(math.isfinite(value) and 0 < abs(value) < 1e-300 for value in outside):
        return Cause(
            "an int in a float field",
            "a Python int was put into Float64.data: its bits are sent as if they were a float",
            "make it a float first: msg.data = float(value)",
        )
    if all(60 <= value <= 90 for value in outside):
        return Cause(
            "out of range",
            "these look like degrees Fahrenheit",
            f"publish degrees Celsius: random.uniform({LOWEST}, {HIGHEST})",
        )
    return Cause("out of range", "values leave the range", f"random.uniform({LOWEST}, {HIGHEST}) stays within it")


def judge_random(found: Values) -> Verdict:
    expected = "values that vary at random: not constant, not a ramp, not a short cycle"
    for run in found.runs:
        pattern = randomness.pattern(run)
        if pattern is not None:
            return failed(
                expected,
                f"{pattern.text} ({len(run)} values)",
                Cause(pattern.name, pattern.text, "draw a new value in every callback: random.uniform(20.0, 30.0)"),
                [f"data: {value:g}" for value in run[:8]],
            )
    longest = max(found.runs, key=len)
    if len(longest) < 3:
        return failed(
            expected,
            f"only {len(longest)} values in {LISTEN_S:g} s",
            Cause("no messages", "the node stops publishing, or hardly ever does", "publish from a timer's callback"),
        )
    return passed(expected, f"{len(longest)} values, no pattern", [f"data: {value:g}" for value in longest[:5]])


def judge_echo(seen: Survey) -> Verdict:
    expected = f"`ros2 topic echo {TOPIC}` shows the values"
    echo = seen.echo
    assert echo is not None
    if echo.samples and len(echo.types) == 1:
        return passed(expected, f"shown with {echo.reliability}, {echo.durability} QoS", [f"data: {echo.samples[0].message['data']}"])
    if len(echo.types) > 1:
        cause = Cause(
            "wrong type",
            f"{TOPIC} carries two types, {' and '.join(echo.types)}; echo cannot choose",
            f"publish nothing but {TYPE} on {TOPIC}",
        )
    elif not echo.types:
        cause = Cause("no publisher", "the publisher was gone when echo looked for it", "keep it for as long as the node lives")
    else:
        cause = Cause(
            "no messages",
            f"a new subscriber got nothing in {echo.limit_s:g} s ({echo.reliability}, {echo.durability})",
            "publish again and again from a timer, and set no short lifespan in the QoS",
        )
    return failed(expected, f"nothing shown in {echo.limit_s:g} s", cause)


def judge_rate(found: Rates) -> Verdict:
    expected = f"some numeric parameter, set at start-up, changes the rate as it says (±{TOLERANCE:.0%})"
    for agreed in _agreeing(found.probes):
        return passed(expected, f"{agreed[0].name} is read in {agreed[0].unit}", [str(probe) for probe in agreed])
    if not found.probes:
        return failed(expected, "no numeric parameter is declared", _rate_not_declared())
    nearest = max(_groups(found.probes), key=lambda group: (_agree(group), len(_swapped(group))))
    wrong = next(probe for probe in nearest if not probe.agrees)
    return failed(expected, str(wrong), _why_rate(nearest, wrong, found.declared), [str(probe) for probe in nearest])


def _rate_not_declared() -> Cause:
    return Cause(
        "parameter not declared",
        "the rate cannot be set from outside",
        f"self.declare_parameter('{SUGGESTED_RATE}', 1.0), and use its value for the timer's period",
    )


def _why_rate(group: Sequence[RateProbe], wrong: RateProbe, declared: tuple[Parameter, ...] | None) -> Cause:
    broken = causes.of_process(wrong.trace)
    if broken is not None:
        return broken
    if declared is not None and wrong.name not in {parameter.name for parameter in declared}:
        return _rate_not_declared()
    measured = [(probe, probe.rate) for probe in group if probe.rate is not None]
    if measured and len(_swapped(group)) == len(measured):
        if wrong.unit == "Hz":
            return Cause(
                "rate used as a period",
                f"{wrong.name} is given in Hz, but the timer waits that many seconds",
                "the timer's period is 1.0 / rate",
            )
        return Cause(
            "period used as a rate",
            f"{wrong.name} is given as a period, but the node publishes that many times a second",
            f"give {wrong.name} to create_timer as it is, or call it a rate",
        )
    rates_seen = [rate.hz for _, rate in measured]
    if len(rates_seen) > 1 and max(rates_seen) <= min(rates_seen) * (1 + TOLERANCE):
        return Cause(
            "parameter ignored",
            f"the rate stays at {rates_seen[0]:.1f} Hz, whatever {wrong.name} says",
            f"use self.get_parameter('{wrong.name}').value for the timer's period",
        )
    return Cause("wrong rate", f"{wrong}", "the timer's period is 1.0 / rate seconds; are there two timers, or a rounding?")


def judge_name(found: Names) -> Verdict:
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
                f"self.declare_parameter('{SUGGESTED_NAME}', 'sensor'), and put its value into a log message",
            ),
        )
    evidence = [str(log) for log in probe.trace.logs[-5:]]
    observed = f"{probe.name}:={probe.value} is in none of {len(probe.trace.logs)} log messages"
    return failed(expected, observed, _why_name(found), evidence)


def _why_name(found: Names) -> Cause:
    for probe in found.probes:
        broken = causes.of_process(probe.trace)
        if broken is not None:
            return broken
        printed = [line.text for line in probe.trace.output if probe.value in line.text]
        if printed:
            return Cause(
                "printed, not logged",
                f"the name is written with print(): {printed[0]}",
                "use self.get_logger().info(...): log messages reach /rosout, where others can read them",
            )
    if found.declared is None:
        return Cause(
            "parameter not declared",
            f"the node answers no parameter call, and {SUGGESTED_NAME} has no effect",
            f"self.declare_parameter('{SUGGESTED_NAME}', 'sensor'), and log its value",
        )
    return Cause(
        "parameter ignored",
        f"{', '.join(probe.name for probe in found.probes)} is declared, but not logged",
        f"self.get_logger().info(f'{{self.get_parameter(\"{found.probes[0].name}\").value}}: ...')",
    )


def judge_shutdown(seen: Survey) -> Verdict:
    return ending.judge(seen.trace, seen.ending)


CHECK = Check(
    "i1.1",
    (
        Criterion("publishes", judge_publishes, (survey,)),
        Criterion("range", judge_range, (values,), after=("publishes",)),
        Criterion("random", judge_random, (values,), after=("publishes",)),
        Criterion("echo", judge_echo, (survey,), after=("publishes",)),
        Criterion("rate", judge_rate, (rates,), after=("publishes",)),
        Criterion("sensor-name", judge_name, (names,)),
        Criterion("shutdown", judge_shutdown, (survey,), bonus=True),
    ),
)
