"""Whether numbers vary as random ones do. Coarse but real randomness (whole degrees, a random walk) must pass."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

SURE = 1e-4
"""A pattern counts when random values would show it by chance less often than this."""

ENOUGH = 8
"""As many values tell when nothing looks suspicious."""

PLENTY = 24
"""As many values tell in any case."""


@dataclass(frozen=True, slots=True)
class Pattern:
    """A regularity: its name ("constant value", "ramp", "short cycle", "not random") and what it is here."""

    name: str
    text: str


def pattern(values: Sequence[float]) -> Pattern | None:
    """The regularity in `values` (in order of time), or None where they vary as random ones do.

    Fewer than three values show nothing either way.
    """
    if len(values) < 3:
        return None
    return _constant(values) or _cycle(values) or _ramp(values) or _zigzag(values) or _curve(values)


def suspicious(values: Sequence[float]) -> bool:
    """Whether more values are needed before `pattern` can be trusted to have found nothing, or something."""
    if len(values) < ENOUGH or pattern(values) is not None:
        return True
    again = max(Counter(step for step in _steps(values) if step != 0).values(), default=0)
    return len(set(values)) < len(values) or again > 2 or _monotone(values) or _unexplained(values) < 0.02


def _constant(values: Sequence[float]) -> Pattern | None:
    if len(set(values)) == 1:
        return Pattern("constant value", f"all {len(values)} values are {values[0]:g}")
    return None


def _cycle(values: Sequence[float]) -> Pattern | None:
    # A random walk chooses among its few steps, not among all the values that it has been at.
    choices = min(len(set(values)), len(set(_steps(values))))
    for period in range(2, len(values) - 2):
        repeats = len(values) - period
        if all(values[i] == values[i + period] for i in range(repeats)) and choices**-repeats < SURE:
            return Pattern("short cycle", f"the same {period} values come again and again")
    return None


def _ramp(values: Sequence[float]) -> Pattern | None:
    steps = _steps(values)
    step, times = max(Counter(steps).items(), key=lambda item: (item[0] != 0, item[1]))
    # Any other step must be a jump back to the start, else a random walk in equal steps would be taken for a ramp.
    others = [other for other in steps if other != step]
    wraps = all(other * step < 0 and abs(other) > 2 * abs(step) for other in others)
    if len(steps) >= 7 and step != 0 and wraps and times >= 0.6 * len(steps):
        return Pattern("ramp", f"each value is the one before it {step:+g}")
    if len(values) >= 10 and _monotone(values):
        return Pattern("ramp", f"all {len(values)} values only go {'up' if values[-1] > values[0] else 'down'}")
    return None


def _zigzag(values: Sequence[float]) -> Pattern | None:
    """Up and down in equal steps, turning at the top and at the bottom only: a random walk turns far more often."""
    steps = _steps(values)
    size, ends = abs(steps[0]), (min(values), max(values))
    turns = [values[i] for i in range(1, len(steps)) if steps[i] != steps[i - 1]]
    even = len(steps) >= 20 and all(abs(step) == size != 0 for step in steps)
    if even and len(turns) <= 3 and all(turn in ends for turn in turns):
        return Pattern("ramp", f"the values go up and down in steps of {size:g}")
    return None


def _curve(values: Sequence[float]) -> Pattern | None:
    if len(values) >= 10 and _unexplained(values) < 5e-4:
        return Pattern(
            "not random", "the values follow a smooth curve, such as a sine: each follows from the two before it"
        )
    return None


def _steps(values: Sequence[float]) -> list[float]:
    return [round(b - a, 9) for a, b in pairwise(values)]


def _monotone(values: Sequence[float]) -> bool:
    pairs = list(pairwise(values))
    return all(a < b for a, b in pairs) or all(a > b for a, b in pairs)


def _unexplained(values: Sequence[float]) -> float:
    """The share of the variance that no linear recurrence x[i] = a x[i-1] + b x[i-2] + c explains (1: all of it).

    Ramps, sines and decays obey such a recurrence exactly; random values do not.
    """
    if len(values) < ENOUGH:
        return 1.0
    import numpy as np

    if not all(abs(value) < 1e150 for value in values):  # nor a NaN: there is nothing to calculate with
        return 1.0
    series = np.asarray(values, dtype=float)
    target = series[2:]
    basis = np.column_stack([series[1:-1], series[:-2], np.ones(len(target))])
    spread = float(np.sum((target - target.mean()) ** 2))
    if spread == 0:
        return 1.0
    solution = np.linalg.lstsq(basis, target, rcond=None)[0]
    return float(np.sum((target - basis @ solution) ** 2)) / spread
