"""I1.1: what is asked of the node, and the facts that are gathered."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from tutor.judge.rates import Rate, describe
from tutor.judge.trace import Echo, Ending, OutputLine, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting import window_s
from tutor.ros_model import Parameter

FILE = "temperature_publisher.py"
TOPIC = "/sensor/temperature"
TYPE = "std_msgs/msg/Float64"
LOWEST, HIGHEST = 20.0, 30.0

LISTEN_S = 26.0
"""Values are collected for at most this long after the first one, so that a doubtful node at 1 Hz shows plenty."""

LEAST_S = 5.0
"""Values are collected for this long in any case: the other starts take as long, and more values tell more."""

FAST_HZ = 8.0
"""The highest rate that is tried first: one of `VALUES`."""

MORE_S = 4.0
"""At `FAST_HZ`, plenty of values come in this time."""

LEAST_VALUES = 3
"""With fewer values of a plain start, neither a regularity nor a range can be told from it."""

ECHO_S = 14.0
"""The echo of a topic that has a message now and then shows one within this time."""

SUGGESTED_RATE, SUGGESTED_NAME = "publish_rate", "sensor_name"
"""The names that are tried where the node never answers a parameter call."""

UNITS: dict[str, Callable[[float], float]] = {
    "Hz": lambda value: value,
    "s": lambda value: 1 / value,
    "ms": lambda value: 1000 / value,
}
"""How a numeric parameter may be read: from its value to the rate in Hz that it asks for."""

VALUES = {"Hz": (2.0, FAST_HZ, 0.7), "s": (0.5, 0.125, 1.5), "ms": (500.0, 125.0, 1500.0)}
"""The slowest ones show a rate that is made a whole number: 0 and 1 Hz, or 1 and 2 s, are beyond the tolerance."""

SPARE_VALUES = {"Hz": (5.0, 1.0, 3.0, 10.0), "s": (1.0, 2.0, 0.2, 0.4), "ms": (200.0, 1000.0, 400.0)}
"""Tried instead where the parameter's type or range does not allow the first ones."""


@dataclass(frozen=True)
class PlainStart:
    """A plain start. `echo` is None where nothing came to echo; `ending` where the process had ended by itself.

    `stuck`: where the node was, innermost frame first, when it did not publish and answered nothing.
    """

    trace: Trace
    parameters: tuple[Parameter, ...] | None
    echo: Echo | None
    ending: Ending | None
    stuck: tuple[Frame, ...] = ()


@dataclass(frozen=True)
class CollectedValues:
    """The values of each of several starts without parameters; `trace` is one of them, for the words of a cause.

    `regular`: the values of a start at a higher rate, where these are plenty and clearly not random.
    """

    runs: tuple[tuple[float, ...], ...]
    trace: Trace | None = None
    regular: tuple[float, ...] = ()

    @property
    def all(self) -> tuple[float, ...]:
        return tuple(value for run in self.runs for value in run)


@dataclass(frozen=True)
class RateProbe:
    """A start with one parameter set: the rate that its `value`, read in `unit`, asks for, and what was measured."""

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
        return self.rate is not None and self.rate.covers(window_s(self.asked_hz)) and self.rate.agrees(self.asked_hz)

    def __str__(self) -> str:
        return (
            f"{self.name}:={self.value:g} asks for {self.asked_hz:g} Hz, measured {describe(self.rate, self.messages)}"
        )


@dataclass(frozen=True)
class RateProbes:
    """All starts that tried a rate. `declared` is None where the node answered no parameter call."""

    declared: tuple[Parameter, ...] | None
    probes: tuple[RateProbe, ...]


@dataclass(frozen=True)
class NameProbe:
    """A start with one string parameter set to `value`; `found` is the log message that bears it, or empty.

    `at_end`: where nothing was found, what the process wrote when it was ended.
    """

    name: str
    value: str
    found: str
    trace: Trace
    at_end: tuple[OutputLine, ...] = ()


@dataclass(frozen=True)
class NameProbes:
    """All starts that tried a name. `declared` is None where the node answered no parameter call."""

    declared: tuple[Parameter, ...] | None
    probes: tuple[NameProbe, ...]


def units(name: str) -> tuple[str, ...]:
    """What a parameter's name says of its unit; all of them where it says nothing, or two things."""
    lower = name.casefold()
    as_rate = any(word in lower for word in ("rate", "hz", "freq"))
    as_period = any(word in lower for word in ("period", "interval"))
    if as_rate and not as_period:
        return ("Hz",)
    if as_period and not as_rate:
        return ("s", "ms")
    return ("Hz", "s", "ms")


def numeric_parameters(declared: Iterable[Parameter]) -> list[Parameter]:
    """The numeric parameters that the learner declared; rclpy declares some of its own for QoS."""
    return [p for p in declared if p.type in ("integer", "double") and not p.name.startswith("qos_overrides")]


def out_of_range(values: Iterable[float]) -> list[float]:
    """Those that are out of range, nan included."""
    return [value for value in values if not LOWEST <= value <= HIGHEST]


def parameter_and_unit(probe: RateProbe) -> tuple[str, str]:
    """Which parameter this is about, and how it is read."""
    return probe.name, probe.unit


def group_probes(probes: Iterable[RateProbe]) -> list[list[RateProbe]]:
    """The probes of each parameter and unit."""
    groups: dict[tuple[str, str], list[RateProbe]] = {}
    for probe in probes:
        groups.setdefault(parameter_and_unit(probe), []).append(probe)
    return list(groups.values())


def agreeing_groups(probes: Iterable[RateProbe]) -> list[list[RateProbe]]:
    """The groups of which every probe agrees, two different rates at least: one may be right by chance."""
    return [group for group in group_probes(probes) if len(group) > 1 and all(probe.agrees for probe in group)]


def count_agreeing(group: Iterable[RateProbe]) -> int:
    """How many of the probes agree."""
    return sum(probe.agrees for probe in group)


def inverted_probes(group: Iterable[RateProbe]) -> list[RateProbe]:
    """The probes that show the period where the rate was asked for, or the other way round."""
    return [probe for probe in group if probe.rate is not None and probe.rate.agrees(1 / probe.asked_hz)]
