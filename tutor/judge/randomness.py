"""Tests whether a series of numbers is random. Coarse but real randomness (whole degrees, a random walk) must pass.

Each test assumes a rule by which a value follows from its predecessors, and counts how often it holds. `SIGNIFICANCE`
bounds the probability that random values follow the rule by chance, even if they are drawn from few distinct values.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

from tutor.judge import series
from tutor.judge.series import MIN_SAMPLE_SIZE as MIN_SAMPLE_SIZE

SIGNIFICANCE = 1e-6
"""A pattern counts if the probability that random values show it by chance is below this."""

COARSE_SAMPLE_SIZE = 12
"""Sample size that is enough if nothing looks suspicious except that values occur twice, as whole degrees do."""

FULL_SAMPLE_SIZE = 24
"""Sample size that is enough in any case."""

VALUE_TOLERANCE = 0.01
"""Two values count as equal if they differ by less than this share of the range, so that jitter hides no pattern."""

SMOOTH_RESIDUAL = 5e-4
"""A series is a curve, not noise, if its predecessors explain all but this share of its variance."""

MAX_MISSED = 3
"""Maximum number of values at the start of a run that an observer may miss because discovery takes time."""

LONGEST_STEPS = 6
"""Maximum number of different steps that a ramp may cycle through."""


@dataclass(frozen=True, slots=True)
class Pattern:
    """A regularity: its name ("constant value", "ramp", "short cycle", "not random") and its description.

    `significant`: every kind of random series shows it less often than `SIGNIFICANCE`. If not, some kind, such as a
    random walk in equal steps, shows it more often; then it only counts if every run of the program shows one.
    """

    name: str
    text: str
    significant: bool = True


def find_pattern(values: Sequence[float]) -> Pattern | None:
    """The regularity in `values` (in order of time), or None if they vary as random ones do.

    Fewer than three values are not enough to find one. NaN and infinities are ignored, unless there is nothing else.
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
    """Whether `find_pattern` needs more values before its result, positive or negative, can be trusted."""
    values = _finite(values)
    if len(values) < MIN_SAMPLE_SIZE or find_pattern(values) is not None:
        return True
    step_repeats = max(Counter(step for step in series.steps(values) if step != 0).values(), default=0)
    coarse = are_coarse(values)
    return (
        (coarse and (len(values) < COARSE_SAMPLE_SIZE or _may_have_begun_to_cycle(values)))
        or step_repeats > (4 if coarse else 2)
        or series.is_monotone(values)
        or any(_follows_in_steps(values, period, _tolerance(values)) for period in range(1, 4))
        or any(_repeats(values, period, VALUE_TOLERANCE * series.span(values)) for period in range(2, len(values) - 1))
        or min(series.unexplained(values, 2), series.unexplained(series.unfold(values), 2)) < 0.02
    )


def are_all_constant(runs: Sequence[Sequence[float]]) -> bool:
    """Whether each run repeats a value of its own, together so often that this cannot be chance.

    Half of the repetitions at most may come from one run, since a fast one may send a slower reading several times.
    """
    repetitions = (min(len(run) - 1, FULL_SAMPLE_SIZE // 2) for run in runs if run)
    return all(len(set(run)) <= 1 for run in runs) and sum(repetitions) >= FULL_SAMPLE_SIZE


def are_coarse(values: Sequence[float]) -> bool:
    """Whether some value occurs more than once, as among whole degrees."""
    return not series.all_distinct(values)


def may_be_one_sequence(values: Sequence[float], others: Sequence[float]) -> bool:
    """Whether two runs of a program may send the same sequence, such as a fixed list or seeded random values.

    The first values of either run may be missing. Values in another order count, too, if each occurs only once: the
    list may be shuffled. Coarse random values have many in common, but not in the same order.
    """
    if not are_coarse(values):
        return len(set(others).intersection(values)) > len(values) / 2
    shifted = [(values[shift:], others) for shift in range(MAX_MISSED + 1)]
    shifted += [(values, others[shift:]) for shift in range(1, MAX_MISSED + 1)]
    pairs = [list(zip(*runs, strict=False)) for runs in shifted]
    return any(sum(a == b for a, b in overlap) > 0.8 * len(overlap) for overlap in pairs)


def _may_have_begun_to_cycle(values: Sequence[float]) -> bool:
    """Whether the last few values, all equal or not, are the same as those before them."""
    return values[-1] == values[-2] or any(
        _repeats(values[first:], period, 0.0)
        for first in range(len(values) // 2)
        for period in range(1, len(values) - first - 2)
    )


def _finite(values: Sequence[float]) -> Sequence[float]:
    return [value for value in values if math.isfinite(value)]


def _constant(values: Sequence[float]) -> Pattern | None:
    if len(set(values)) == 1:
        return Pattern("constant value", f"all {len(values)} values are {values[0]:g}")
    return None


def _ramp(values: Sequence[float]) -> Pattern | None:
    steps = series.steps(values)
    step, times = max(Counter(steps).items(), key=lambda item: (item[0] != 0, item[1]))
    # Any other step must be a jump back to the start; otherwise a random walk in equal steps would pass for a ramp.
    others = [other for other in steps if other != step]
    wraps = all(other * step < 0 and abs(other) > 2 * abs(step) for other in others)
    if len(steps) >= 9 and step != 0 and wraps and times >= 0.6 * len(steps):
        return Pattern("ramp", f"each value is the one before it {step:+g}")
    if len(values) >= 14 and series.is_monotone(values):
        direction = "up" if values[-1] > values[0] else "down"
        significant = len(values) >= FULL_SAMPLE_SIZE
        return Pattern("ramp", f"all {len(values)} values only go {direction}", significant=significant)
    return None


def _cycle(values: Sequence[float]) -> Pattern | None:
    for first in range(len(values) // 4 + 1):  # a program may take a while to enter its cycle
        rest = values[first:]
        tolerance = VALUE_TOLERANCE * series.span(rest)
        # A random walk chooses among its few steps, not among all the values that it has visited.
        choices = min(
            series.count_distinct(rest, tolerance),
            series.count_distinct(series.steps(rest), VALUE_TOLERANCE * series.span(series.steps(rest))),
        )
        for period in range(2, len(rest) - 2):
            repeats = len(rest) - period
            if not _repeats(rest, period, tolerance):
                continue
            chance = max(choices**-repeats, (2 * VALUE_TOLERANCE) ** repeats)  # that equal values come in this order
            if series.all_distinct(rest[:period]) and _repeats(rest, period, 1e-9):
                chance = min(chance, _chance_of_cycle(period, repeats))
            if chance < SIGNIFICANCE / 10:  # a margin, since many periods and starting points are tried
                return Pattern("short cycle", f"the same {period} values come again and again")
    return None


def _repeats(values: Sequence[float], period: int, tolerance: float) -> bool:
    """Whether each value equals the one `period` places before it, within the tolerance."""
    return all(abs(a - b) <= tolerance for a, b in zip(values, values[period:], strict=False))


@cache
def _chance_of_cycle(period: int, repeats: int) -> float:
    """The probability that `period` draws from a list are distinct and `repeats` more repeat them in order.

    The maximum over all plausible lengths of the list.
    """
    if repeats < 3:
        return 1.0
    lengths = range(period, 40 * period)
    return max(math.prod(1 - i / length for i in range(period)) / float(length**repeats) for length in lengths)


def _zigzag(values: Sequence[float]) -> Pattern | None:
    """Up and down in equal steps, turning only at the top and the bottom: a random walk turns far more often."""
    steps = [step for step in series.steps(values) if step != 0]
    if len(steps) < 20:
        return None
    size, times = Counter(abs(step) for step in steps).most_common(1)[0]
    turns = [
        values[i] for i in range(1, len(values) - 1) if (values[i] - values[i - 1]) * (values[i + 1] - values[i]) < 0
    ]
    low, high = min(values), max(values)
    equal_steps = times >= 0.75 * len(steps) and all(abs(step) <= size * (1 + VALUE_TOLERANCE) for step in steps)
    turns_at_ends = all(min(turn - low, high - turn) < 0.5 * size for turn in turns)
    if equal_steps and turns_at_ends and len(turns) <= 5 and high - low > 3 * size:
        return Pattern("ramp", f"the values go up and down in steps of {size:g}", significant=False)
    return None


def _sawtooth(values: Sequence[float]) -> Pattern | None:
    """A ramp that wraps around at the end of its range, with any step, as (i * 3.7) % 10, or with a cycle of steps."""
    tolerance = _tolerance(values)
    distinct, share = series.count_distinct(values, tolerance), tolerance / (series.span(values) or 1.0)
    chance = min(0.5, max(2 / distinct, 4 * share))  # that a random value falls where the rule says
    for period in range(1, LONGEST_STEPS + 1):
        checked = len(values) - 1 - period
        if checked >= 6 and chance**checked < SIGNIFICANCE and _follows_in_steps(values, period, tolerance):
            return Pattern(
                "ramp",
                f"each value is the one before it {series.steps(values)[0]:+g}, and starts over at the end of the range"
                if period == 1
                else f"the values go on in the same {period} steps, and start over at the end of the range",
            )
    return None


def _follows_in_steps(values: Sequence[float], period: int, tolerance: float) -> bool:
    """Whether the steps repeat with this period, except for jumps that are all of the same size.

    That size is the length of the range at whose end the ramp wraps around, so it exceeds the span of the values.
    """
    span = series.span(values)
    steps = [b - a for a, b in pairwise(values)]
    changes = [b - a for a, b in zip(steps, steps[period:], strict=False)]
    if len(changes) < 3 or not math.isfinite(span) or span == 0:
        return False
    jumps = [abs(change) for change in changes if abs(change) > tolerance]
    if not jumps:
        return True
    # With few distinct values, such as heads and tails, every second change is as large as the span.
    min_jump = span - tolerance if series.count_distinct(values, tolerance) >= MIN_SAMPLE_SIZE else span * (1 + 1e-6)
    return min(jumps) > min_jump and max(jumps) - min(jumps) <= 2 * tolerance


def _tolerance(values: Sequence[float]) -> float:
    """Tolerance for the change from one step to another: enough for jitter, or for rounding to a few decimals."""
    span = series.span(values)
    if not all(abs(value) < 1e15 for value in values):
        return VALUE_TOLERANCE * span
    grain = next((g for g in (1.0, 0.1, 0.01) if all(abs(v / g - round(v / g)) < 1e-6 for v in values)), 0.0)
    return max(VALUE_TOLERANCE * span, 2.1 * grain if grain <= span / 40 else 0.0)


def _curve(values: Sequence[float]) -> Pattern | None:
    if (
        len(values) < FULL_SAMPLE_SIZE
        and series.count_distinct(values, VALUE_TOLERANCE * series.span(values)) < MIN_SAMPLE_SIZE
    ):
        return None  # a few values, even fewer of them distinct, fit some curve now and then by chance
    smooth = (len(values) >= 10 and series.unexplained(values, 2) < SMOOTH_RESIDUAL) or (
        len(values) >= 16 and series.unexplained(values, 4) < SMOOTH_RESIDUAL
    )
    if smooth:
        return Pattern(
            "not random",
            "the values follow a smooth curve, such as a sine: each follows from those before it",
            significant=len(values) >= FULL_SAMPLE_SIZE,
        )
    if len(values) >= 12 and series.unexplained(series.unfold(values), 2) < SMOOTH_RESIDUAL:
        return Pattern(
            "not random",
            "the values go up and down between two ends: each follows from the two before it",
            significant=len(values) >= FULL_SAMPLE_SIZE,
        )
    return None
