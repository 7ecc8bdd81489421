"""B1.3: the questions tell right answers from those that are wrong for some numbers only, and what gets no answer."""

from __future__ import annotations

from collections.abc import Callable
from math import inf

import pytest

from checks.b1_3_own_message import CHECK, IN_RANGE, questions
from tests.checks.builders import assert_failed, graph, judge_of, trace
from tutor.exercise.service_calls import ServiceCalls
from tutor.judge.trace import CallAnswer

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


def asked(value: int, inside: bool | None) -> CallAnswer:
    """A call that asks whether a value is from 0 to 10, and its answer."""
    response = None if inside is None else {"inside": inside}
    return CallAnswer(IN_RANGE.name, {"value": value, "low": 0, "high": 10}, response, 1000.0, 1005.0)


@pytest.mark.parametrize(
    ("gone", "words"),
    [((), "answers other calls, but not this one"), ((IN_RANGE.name,), "was there, and no longer is")],
)
def test_a_service_that_is_gone_is_not_said_to_answer_other_calls(gone: tuple[str, ...], words: str) -> None:
    seen = trace(graph=graph(services={IN_RANGE.name: IN_RANGE.type}))
    simple = ServiceCalls(seen, (asked(5, True),))
    calls = ServiceCalls(seen, (asked(5, True), asked(4, None)), gone=gone)
    assert_failed(judge_of(CHECK, "answers")(calls, simple), "no answer", words, check=CHECK)
    silent = ServiceCalls(seen, (asked(5, None),), gone=gone)
    words = words if gone else "is there, and does not answer a call"
    assert_failed(judge_of(CHECK, "in-range")(silent), "no answer", words, check=CHECK)
