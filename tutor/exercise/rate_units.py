"""Starts that probe which parameter sets a rate, and in which unit the learner's parameter is read."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from tutor.judge.rates import Rate, describe
from tutor.judge.trace import Trace
from tutor.judge.waiting_for_nodes import window_s
from tutor.ros_model import Parameter

FAST_HZ = 8.0
"""The highest rate among the first choices in `PROBE_VALUES`."""

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
    def key(self) -> tuple[str, str]:
        """The parameter and the unit that it was read in: what probes are grouped by."""
        return self.name, self.unit

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
        """True if the node spins, as it must to answer parameter calls; None if it has no services for these."""
        if self.declared is None and not any(probe.trace.graph.parameter_nodes for probe in self.probes):
            return None
        return self.declared is not None


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


def has_known_unit(name: str) -> bool:
    """Whether a parameter's name says in which unit it sets the rate."""
    return len(possible_units(name)) < len(UNITS)


def values_to_probe(parameter: Parameter, unit: str) -> list[float]:
    """The values that a parameter's type and range allow."""
    low, high = parameter.minimum, parameter.maximum
    allowed = [
        value
        for value in (*PROBE_VALUES[unit], *FALLBACK_VALUES[unit])
        if (parameter.type != "integer" or value == int(value))
        and (low is None or low <= value)
        and (high is None or value <= high)
    ]
    return allowed[: len(PROBE_VALUES[unit])]


def group_probes(probes: Iterable[RateProbe]) -> list[list[RateProbe]]:
    """Group probes by parameter and unit."""
    groups: dict[tuple[str, str], list[RateProbe]] = {}
    for probe in probes:
        groups.setdefault(probe.key, []).append(probe)
    return list(groups.values())


def find_agreeing_groups(probes: Iterable[RateProbe]) -> list[list[RateProbe]]:
    """The groups of two or more probes that all agree: a single rate may be right by chance."""
    return [group for group in group_probes(probes) if len(group) > 1 and all(probe.agrees for probe in group)]


def count_agreeing(group: Iterable[RateProbe]) -> int:
    """Count the probes whose measured rate agrees with the requested one."""
    return sum(probe.agrees for probe in group)


def find_inverted_probes(group: Iterable[RateProbe]) -> list[RateProbe]:
    """The probes whose rate is the reciprocal of the requested one: a rate taken for a period, or vice versa."""
    return [probe for probe in group if probe.rate is not None and probe.rate.agrees_with(1 / probe.asked_hz)]


def are_inverted(group: Iterable[RateProbe], *, min_measured: int = 1) -> bool:
    """Whether at least this many rates could be measured, and all are the reciprocals of the requested ones."""
    measured = [probe for probe in group if probe.rate is not None]
    return len(measured) >= min_measured and len(find_inverted_probes(measured)) == len(measured)
