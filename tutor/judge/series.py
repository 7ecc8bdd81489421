"""Arithmetic on values and their series, as the forms and the patterns in `tutor.judge.randomness` need it. Pure."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from itertools import pairwise

MIN_SAMPLE_SIZE = 8
"""Sample size that is enough if nothing looks suspicious."""


def steps(values: Sequence[float]) -> list[float]:
    """Return the differences between neighbours, rounded to nine decimals."""
    return [round(b - a, 9) for a, b in pairwise(values)]


def span(values: Sequence[float]) -> float:
    """Return the largest value minus the smallest."""
    return max(values) - min(values)


def all_distinct(values: Sequence[float]) -> bool:
    """Return whether no value occurs twice."""
    return len(set(values)) == len(values)


def count_distinct(values: Sequence[float], tolerance: float) -> int:
    """Return the number of distinct values, where neighbours within the tolerance count as one."""
    ordered = sorted(values)
    return 1 + sum(b - a > tolerance for a, b in pairwise(ordered))


def is_monotone(values: Sequence[float]) -> bool:
    """Return whether every value is larger than the one before it, or every value smaller."""
    pairs = list(pairwise(values))
    return all(a < b for a, b in pairs) or all(a > b for a, b in pairs)


def unfold(values: Sequence[float]) -> list[float]:
    """Map a triangle wave between two (integer) ends to a cosine; the result is arbitrary for any other series."""
    if not all(abs(value) < 1e15 for value in values):
        return []
    low, high = math.floor(min(values)), math.ceil(max(values))
    return [math.cos(math.pi * (value - low) / (high - low)) for value in values] if high > low else []


def unexplained(values: Sequence[float], order: int) -> float:
    """Return the share of the variance (0 to 1) that the best linear recurrence leaves.

    The recurrence is x[i] = a x[i-1] + b x[i-2] + ... + c. Ramps and sines (order 2) and sums of two of them (order 4)
    obey one exactly; random values do not.
    """
    if len(values) < MIN_SAMPLE_SIZE:
        return 1.0
    import numpy as np

    if not all(abs(value) < 1e150 for value in values):
        return 1.0
    series = np.asarray(values, dtype=float)
    target = series[order:]
    lagged = [series[order - lag : len(series) - lag] for lag in range(1, order + 1)]
    basis = np.column_stack([*lagged, np.ones(len(target))])
    variation = float(np.sum((target - target.mean()) ** 2))
    if variation == 0:
        return 1.0
    solution = np.linalg.lstsq(basis, target, rcond=None)[0]
    return float(np.sum((target - basis @ solution) ** 2) / variation)


def is_int_in_float(value: object) -> bool:
    """Whether a float is what arrives of an int that was put into a float field: rclpy sends its bits as a float's.

    These are the subnormal numbers, closer to 0 than anything that a node measures or computes.
    """
    return isinstance(value, float) and 0.0 < abs(value) < sys.float_info.min
