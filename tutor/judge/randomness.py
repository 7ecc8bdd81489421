"""Whether numbers vary as random ones do. Coarse but real randomness (whole degrees, a random walk) must pass.

Each test states how the next value would follow from those before it, and counts how often it does. `SIGNIFICANCE`
bounds how often random values would do so by chance, also where they are drawn from a few values only.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

SIGNIFICANCE = 1e-6
"""A pattern counts when random values would show it by chance less often than this."""

MIN_SAMPLE_SIZE = 8
"""This many values are enough where nothing looks suspicious."""

FULL_SAMPLE_SIZE = 24
"""This many values are enough in any case."""

VALUE_TOLERANCE = 0.01
"""Two values are alike when they differ by less than this share of the range: jitter or rounding hides no pattern."""

SMOOTH_RESIDUAL = 5e-4
"""Values of which all but this share of the variance follows from those before are a curve, not noise."""

LONGEST_STEPS = 6
"""A ramp may go in a round of up to this many different steps."""


@dataclass(frozen=True, slots=True)
class Pattern:
    """A regularity: its name ("constant value", "ramp", "short cycle", "not random") and what it is here.

    `significant`: random values of every kind show it less often than `SIGNIFICANCE`. Else some kind, such as a walk
    in equal steps, shows it more often: it counts where every start of the program shows one.
    """

    name: str
    text: str
    significant: bool = True


def find_pattern(values: Sequence[float]) -> Pattern | None:
    """The regularity in `values` (in order of time), or None where they vary as random ones do.

    Fewer than three values show nothing either way. What is not a number is left out, unless there is nothing else.
    """
    numbers = _finite(values)
    if len(values) >= 3 and not numbers:
        return Pattern("constant value", f"none of {len(values)} values is a number")
    if len(numbers) < 3:
        return None
    return (
        _constant(numbers)
        or _cycle(numbers)
        or _ramp(numbers)
        or _zigzag(numbers)
        or _sawtooth(numbers)
        or _curve(numbers)
    )


def needs_more_values(values: Sequence[float]) -> bool:
    """Whether more values are needed before `pattern` can be trusted to have found nothing, or something."""
    values = _finite(values)
    if len(values) < MIN_SAMPLE_SIZE or find_pattern(values) is not None:
        return True
    again = max(Counter(step for step in _steps(values) if step != 0).values(), default=0)
    return (
        len(set(values)) < len(values)
        or again > 2
        or _monotone(values)
        or any(_follows_in_steps(values, period, _tolerance(values)) for period in range(1, 4))
        or any(_comes_again(values, period, VALUE_TOLERANCE * _span(values)) for period in range(2, len(values) - 1))
        or min(_unexplained(values, 2), _unexplained(_unfolded(values), 2)) < 0.02
    )


def _finite(values: Sequence[float]) -> Sequence[float]:
    return [value for value in values if math.isfinite(value)]


def _constant(values: Sequence[float]) -> Pattern | None:
    if len(set(values)) == 1:
        return Pattern("constant value", f"all {len(values)} values are {values[0]:g}")
    return None


def _ramp(values: Sequence[float]) -> Pattern | None:
    steps = _steps(values)
    step, times = max(Counter(steps).items(), key=lambda item: (item[0] != 0, item[1]))
    # Any other step must be a jump back to the start, else a random walk in equal steps would be taken for a ramp.
    others = [other for other in steps if other != step]
    wraps = all(other * step < 0 and abs(other) > 2 * abs(step) for other in others)
    if len(steps) >= 9 and step != 0 and wraps and times >= 0.6 * len(steps):
        return Pattern("ramp", f"each value is the one before it {step:+g}")
    if len(values) >= 14 and _monotone(values):
        way = "up" if values[-1] > values[0] else "down"
        return Pattern("ramp", f"all {len(values)} values only go {way}", significant=len(values) >= FULL_SAMPLE_SIZE)
    return None


def _cycle(values: Sequence[float]) -> Pattern | None:
    for first in range(len(values) // 4 + 1):  # it may take a while until a program is in its round
        rest = values[first:]
        tolerance = VALUE_TOLERANCE * _span(rest)
        # A random walk chooses among its few steps, not among all the values that it has been at.
        choices = min(_different(rest, tolerance), _different(_steps(rest), VALUE_TOLERANCE * _span(_steps(rest))))
        for period in range(2, len(rest) - 2):
            repeats = len(rest) - period
            if not _comes_again(rest, period, tolerance):
                continue
            chance = max(choices**-repeats, (2 * VALUE_TOLERANCE) ** repeats)  # that alike values come in this order
            if _distinct(rest[:period]) and _comes_again(rest, period, 1e-9):
                chance = min(chance, _chance_of_a_round(period, repeats))
            if chance < SIGNIFICANCE / 10:  # there are many periods, and many places to begin, to try
                return Pattern("short cycle", f"the same {period} values come again and again")
    return None


def _comes_again(values: Sequence[float], period: int, tolerance: float) -> bool:
    return all(abs(a - b) <= tolerance for a, b in zip(values, values[period:], strict=False))


@cache
def _chance_of_a_round(period: int, repeats: int) -> float:
    """How often draws from a list, of whatever length, are all different at first and then come again in order."""
    if repeats < 3:
        return 1.0
    lengths = range(period, 40 * period)
    return max(math.prod(1 - i / length for i in range(period)) / float(length**repeats) for length in lengths)


def _zigzag(values: Sequence[float]) -> Pattern | None:
    """Up and down in equal steps, turning at the top and at the bottom only: a random walk turns far more often."""
    steps = [step for step in _steps(values) if step != 0]
    if len(steps) < 20:
        return None
    size, times = Counter(abs(step) for step in steps).most_common(1)[0]
    turns = [
        values[i] for i in range(1, len(values) - 1) if (values[i] - values[i - 1]) * (values[i + 1] - values[i]) < 0
    ]
    low, high = min(values), max(values)
    even = times >= 0.75 * len(steps) and all(abs(step) <= size * (1 + VALUE_TOLERANCE) for step in steps)
    at_ends = all(min(turn - low, high - turn) < 0.5 * size for turn in turns)
    if even and at_ends and len(turns) <= 5 and high - low > 3 * size:
        return Pattern("ramp", f"the values go up and down in steps of {size:g}", significant=False)
    return None


def _sawtooth(values: Sequence[float]) -> Pattern | None:
    """A ramp that starts over when it leaves its range, whatever its step: (i * 3.7) % 10, or steps taken in turn."""
    tolerance = _tolerance(values)
    few, share = _different(values, tolerance), tolerance / (_span(values) or 1.0)
    likely = min(0.5, max(2 / few, 4 * share))  # that one more value falls where the rule says, by chance
    for period in range(1, LONGEST_STEPS + 1):
        checked = len(values) - 1 - period
        if checked >= 6 and likely**checked < SIGNIFICANCE and _follows_in_steps(values, period, tolerance):
            return Pattern(
                "ramp",
                f"each value is the one before it {_steps(values)[0]:+g}, and starts over at the end of the range"
                if period == 1
                else f"the values go on in the same {period} steps, and start over at the end of the range",
            )
    return None


def _follows_in_steps(values: Sequence[float], period: int, tolerance: float) -> bool:
    """Whether the steps come again after `period` of them, but for jumps by one and the same amount.

    The amount is the length of the range, so any two values are less far apart.
    """
    span = _span(values)
    steps = [b - a for a, b in pairwise(values)]
    changes = [b - a for a, b in zip(steps, steps[period:], strict=False)]
    if len(changes) < 3 or not math.isfinite(span) or span == 0:
        return False
    jumps = [abs(change) for change in changes if abs(change) > tolerance]
    if not jumps:
        return True
    # Of few values, such as heads and tails, every second change is as long as the range.
    least = span - tolerance if _different(values, tolerance) >= MIN_SAMPLE_SIZE else span * (1 + 1e-6)
    return min(jumps) > least and max(jumps) - min(jumps) <= 2 * tolerance


def _tolerance(values: Sequence[float]) -> float:
    """How far a change of steps may be off: what jitter does to it, or rounding to a few decimals."""
    span = _span(values)
    if not all(abs(value) < 1e15 for value in values):
        return VALUE_TOLERANCE * span
    grain = next((g for g in (1.0, 0.1, 0.01) if all(abs(v / g - round(v / g)) < 1e-6 for v in values)), 0.0)
    return max(VALUE_TOLERANCE * span, 2.1 * grain if grain <= span / 40 else 0.0)


def _curve(values: Sequence[float]) -> Pattern | None:
    if len(values) < FULL_SAMPLE_SIZE and _different(values, VALUE_TOLERANCE * _span(values)) < MIN_SAMPLE_SIZE:
        return None  # few values, drawn from fewer: some curve goes through them now and then
    smooth = (len(values) >= 10 and _unexplained(values, 2) < SMOOTH_RESIDUAL) or (
        len(values) >= 16 and _unexplained(values, 4) < SMOOTH_RESIDUAL
    )
    if smooth:
        return Pattern(
            "not random",
            "the values follow a smooth curve, such as a sine: each follows from those before it",
            significant=len(values) >= FULL_SAMPLE_SIZE,
        )
    if len(values) >= 12 and _unexplained(_unfolded(values), 2) < SMOOTH_RESIDUAL:
        return Pattern(
            "not random",
            "the values go up and down between two ends: each follows from the two before it",
            significant=len(values) >= FULL_SAMPLE_SIZE,
        )
    return None


def _steps(values: Sequence[float]) -> list[float]:
    return [round(b - a, 9) for a, b in pairwise(values)]


def _span(values: Sequence[float]) -> float:
    return max(values) - min(values)


def _distinct(values: Sequence[float]) -> bool:
    return len(set(values)) == len(values)


def _different(values: Sequence[float], tolerance: float) -> int:
    """How many values there are, taking those that are alike for one."""
    ordered = sorted(values)
    return 1 + sum(b - a > tolerance for a, b in pairwise(ordered))


def _monotone(values: Sequence[float]) -> bool:
    pairs = list(pairwise(values))
    return all(a < b for a, b in pairs) or all(a > b for a, b in pairs)


def _unfolded(values: Sequence[float]) -> list[float]:
    """A triangle wave between two (whole) ends as the cosine that it is a picture of; anything else, somehow."""
    if not all(abs(value) < 1e15 for value in values):
        return []
    low, high = math.floor(min(values)), math.ceil(max(values))
    return [math.cos(math.pi * (value - low) / (high - low)) for value in values] if high > low else []


def _unexplained(values: Sequence[float], order: int) -> float:
    """The share of the variance that no linear recurrence x[i] = a x[i-1] + b x[i-2] + ... + c explains (1: all of it).

    Ramps, sines (of order 2) and sums of two of them (of order 4) obey one exactly; random values do not.
    """
    if len(values) < MIN_SAMPLE_SIZE:
        return 1.0
    import numpy as np

    if not all(abs(value) < 1e150 for value in values):
        return 1.0
    series = np.asarray(values, dtype=float)
    target = series[order:]
    before = [series[order - back : len(series) - back] for back in range(1, order + 1)]
    basis = np.column_stack([*before, np.ones(len(target))])
    spread = float(np.sum((target - target.mean()) ** 2))
    if spread == 0:
        return 1.0
    solution = np.linalg.lstsq(basis, target, rcond=None)[0]
    return float(np.sum((target - basis @ solution) ** 2) / spread)
