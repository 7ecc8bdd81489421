"""B1.3: the questions tell right answers from those that are wrong for some numbers only."""

from __future__ import annotations

from collections.abc import Callable
from math import inf

import pytest

from checks.b1_3_own_message import IN_RANGE, questions

Answer = Callable[[int, int, int], bool]


def cached_by_value() -> Answer:
    """Answers that are remembered by the value alone."""
    known: dict[int, bool] = {}
    return lambda value, low, high: known.setdefault(value, low <= value <= high)


@pytest.mark.parametrize(
    "make",
    [
        lambda: lambda value, low, high: bool(value) and low <= value <= high,
        lambda: lambda value, low, high: (low or -inf) <= value <= high,
        lambda: lambda value, low, high: low <= value <= (high or inf),
        lambda: lambda value, low, high: bool(low) and bool(high) and low <= value <= high,
        lambda: lambda value, low, high: low < high and low <= value <= high,
        lambda: lambda value, low, high: float(low) <= float(value) <= high,
        lambda: lambda value, low, high: low <= float(value) <= float(high),
        lambda: lambda value, low, high: low <= value < high,
        lambda: lambda value, low, high: low < value <= high,
        lambda: lambda value, low, high: low <= abs(value) <= high,
        cached_by_value,
    ],
)
def test_an_answer_that_is_wrong_for_some_numbers_is_always_found(make: Callable[[], Answer]) -> None:
    assert IN_RANGE.computes is not None
    for _ in range(20):
        wrong = make()
        assert any(wrong(*asked) != IN_RANGE.computes(*asked) for _, asked in questions())


def test_the_limits_of_a_request_are_never_the_wrong_way_round() -> None:
    assert all(low <= high for _, (_, low, high) in questions())
