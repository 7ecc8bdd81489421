"""I1.1: the requirements, and the facts that the scenarios gather for the judges."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from tutor.judge.rates import Rate, describe
from tutor.judge.trace import Echo, Ending, OutputLine, Sample, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting import window_s
from tutor.ros_model import Parameter

FILE = "temperature_publisher.py"
TOPIC = "/sensor/temperature"
TYPE = "std_msgs/msg/Float64"
LOWEST, HIGHEST = 20.0, 30.0

MAX_COLLECT_S = 26.0
"""Longest value collection, counted from the first message: enough for a suspicious 1 Hz node to show plenty."""

MIN_COLLECT_S = 5.0
"""Shortest value collection: the other runs take this long anyway, and more values mean better evidence."""

FAST_HZ = 8.0
"""The highest rate among the first choices in `PROBE_VALUES`."""

FAST_COLLECT_S = 4.0
"""Extra collection time for suspicious values at `FAST_HZ`: long enough for plenty of them."""

MIN_VALUES = 3
"""Fewer values than this from a plain start show neither a pattern nor a range."""

MATCHED_S = 1.3
"""Messages sent within this time of the first sign of a publisher do not count: whether they reach us is a race.

Some nodes also pause for a second before a first message.
"""

GO_ON_S = 0.9
"""Messages go on arriving if those that count span this time."""

ECHO_LIMIT_S = 14.0
"""Time limit of the echo: enough even for a topic with only an occasional message."""

SUGGESTED_RATE, SUGGESTED_NAME = "publish_rate", "sensor_name"
"""The skeleton's parameter names, tried when the node never answers a parameter call."""

UNITS: dict[str, Callable[[float], float]] = {
    "Hz": lambda value: value,
    "s": lambda value: 1 / value,
    "ms": lambda value: 1000 / value,
}
"""The units a numeric parameter may be in; each function converts a value to the requested rate in Hz."""

PROBE_VALUES = {"Hz": (2.0, FAST_HZ, 0.7), "s": (0.5, 0.125, 1.5), "ms": (500.0, 125.0, 1500.0)}
"""Values to probe per unit. The slowest one exposes rounding: 0 and 1 Hz, or 1 and 2 s, are out of tolerance."""

FALLBACK_VALUES = {"Hz": (5.0, 1.0, 3.0, 10.0), "s": (1.0, 2.0, 0.2, 0.4), "ms": (200.0, 1000.0, 400.0)}
"""Fallbacks for values in `PROBE_VALUES` that the parameter's type or range does not allow."""


@dataclass(frozen=True)
class PlainStart:
    """A start without parameters, interrupted with Ctrl+C at the end.

    `counted_from`: messages sent before this time do not count (see `MATCHED_S`), in seconds since the epoch.
    `parameters`: None if the node answered no parameter call, and, as nobody needs them then, if messages go on
    arriving. `echo`: None if they do not.
    `ending`: None if the process had already exited. `stuck`: the stack, innermost frame first, of a node that neither
    published nor answered. `stuck_for_ever`: by that stack, it will never publish.
    """

    trace: Trace
    parameters: tuple[Parameter, ...] | None
    echo: Echo | None
    ending: Ending | None
    stuck: tuple[Frame, ...] = ()
    stuck_for_ever: bool = False
    counted_from: float = 0.0

    @property
    def messages_go_on(self) -> bool:
        """Whether messages went on arriving, in whichever part of its start the node sent those that may be missing."""
        return go_on(self.trace.samples_on(TOPIC), self.counted_from)


@dataclass(frozen=True)
class CollectedValues:
    """The values from several starts without parameters, one tuple per run.

    `trace`: one of these runs, for wording a cause. `regular`: the values of a run at a higher rate; filled only if
    there are plenty and they are clearly not random.
    """

    runs: tuple[tuple[float, ...], ...]
    trace: Trace | None = None
    regular: tuple[float, ...] = ()

    @property
    def all(self) -> tuple[float, ...]:
        return tuple(value for run in self.runs for value in run)


@dataclass(frozen=True)
class RateProbe:
    """A start with parameter `name` set to `value`, in `unit`, and the rate that was measured."""

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
        return (
            self.rate is not None and self.rate.covers(window_s(self.asked_hz)) and self.rate.agrees_with(self.asked_hz)
        )

    def __str__(self) -> str:
        measured = describe(self.rate, self.messages)
        return f"{self.name}:={self.value:g} asks for {self.asked_hz:.3g} Hz, measured {measured}"


@dataclass(frozen=True)
class RateProbes:
    """All starts that probed a rate. `declared`: None if the node answered no parameter call."""

    declared: tuple[Parameter, ...] | None
    probes: tuple[RateProbe, ...]

    @property
    def spins(self) -> bool | None:
        """Whether the node spins, as it must to answer parameter calls; None if it has no services for these."""
        if self.declared is None and not any(probe.trace.graph.parameter_nodes for probe in self.probes):
            return None
        return self.declared is not None


@dataclass(frozen=True)
class NameProbe:
    """A start with the string parameter `name` set to `value`.

    `found`: the log message that contains the value, or "". `at_end`: if none does, the output during shutdown.
    """

    name: str
    value: str
    found: str
    trace: Trace
    at_end: tuple[OutputLine, ...] = ()


@dataclass(frozen=True)
class NameProbes:
    """All starts that probed a name. `declared`: None if the node answered no parameter call."""

    declared: tuple[Parameter, ...] | None
    probes: tuple[NameProbe, ...]


def possible_units(name: str) -> tuple[str, ...]:
    """Return the units that a parameter's name suggests; all of them if it is neutral or ambiguous."""
    lower = name.casefold()
    as_rate = any(word in lower for word in ("rate", "hz", "freq"))
    as_period = any(word in lower for word in ("period", "interval"))
    if as_rate and not as_period:
        return ("Hz",)
    if as_period and not as_rate:
        return ("s", "ms")
    return ("Hz", "s", "ms")


def go_on(samples: Sequence[Sample], counted_from: float) -> bool:
    """Whether the samples that were sent after this time span `GO_ON_S`."""
    first = next((sample.source_time for sample in samples if sample.source_time >= counted_from), math.inf)
    return bool(samples) and samples[-1].source_time - first >= GO_ON_S


def numeric_parameters(declared: Iterable[Parameter]) -> list[Parameter]:
    """The learner's own numeric parameters, without the QoS overrides that rclpy declares."""
    return [p for p in declared if p.type in ("integer", "double") and not p.name.startswith("qos_overrides")]


def find_out_of_range(values: Iterable[float]) -> list[float]:
    """The values outside the range, NaN included."""
    return [value for value in values if not LOWEST <= value <= HIGHEST]


def parameter_and_unit(probe: RateProbe) -> tuple[str, str]:
    """The parameter that was probed and the unit it was read in: the key that probes are grouped by."""
    return probe.name, probe.unit


def group_probes(probes: Iterable[RateProbe]) -> list[list[RateProbe]]:
    """Group probes by parameter and unit."""
    groups: dict[tuple[str, str], list[RateProbe]] = {}
    for probe in probes:
        groups.setdefault(parameter_and_unit(probe), []).append(probe)
    return list(groups.values())


def find_agreeing_groups(probes: Iterable[RateProbe]) -> list[list[RateProbe]]:
    """The groups of two or more probes that all agree: a single rate may be right by chance."""
    return [group for group in group_probes(probes) if len(group) > 1 and all(probe.agrees for probe in group)]


def are_inverted(group: Iterable[RateProbe], *, min_measured: int = 1) -> bool:
    """Whether at least this many rates could be measured, and all are the reciprocals of the requested ones."""
    measured = [probe for probe in group if probe.rate is not None]
    return len(measured) >= min_measured and len(find_inverted_probes(measured)) == len(measured)


def has_known_unit(name: str) -> bool:
    """Whether a parameter's name says in which unit it sets the rate."""
    return len(possible_units(name)) < len(UNITS)


def count_agreeing(group: Iterable[RateProbe]) -> int:
    """Count the probes whose measured rate agrees with the requested one."""
    return sum(probe.agrees for probe in group)


def find_inverted_probes(group: Iterable[RateProbe]) -> list[RateProbe]:
    """The probes whose rate is the reciprocal of the requested one: a rate taken for a period, or vice versa."""
    return [probe for probe in group if probe.rate is not None and probe.rate.agrees_with(1 / probe.asked_hz)]
