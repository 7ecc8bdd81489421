"""I1.2: what the numbers in a summary are that states no true rate."""

from __future__ import annotations

from collections.abc import Sequence

from checks.i1_2_message_statistics.count import Fault
from checks.i1_2_message_statistics.log_lines import Number
from checks.i1_2_message_statistics.logged_summaries import Summary
from checks.i1_2_message_statistics.rate import (
    DELAY_S,
    Range,
    covered_count,
    elapsed_s,
    numbers_except_count,
    true_rates,
)

WHOLE_SECONDS_ERROR_S = 0.01
"""Maximum deviation from whole seconds of the time that a rate implies: rates are often written with two digits."""

SAME_TIME_S = 0.2
"""Maximum difference between two of our time measurements that count as equal."""

MIN_LEAD_S = 0.7
"""A clock that starts with the node is at least this much ahead of the first message."""


def find_wrong_rate(summary: Summary, summaries: Sequence[Summary]) -> Fault:
    """What the numbers in `summary`, which states no true rate, are instead."""
    found, true = numbers_except_count(summary), true_rates(summary)
    for number in found:
        if number.value > 0 and 1 / number.value in true:
            return {"fault": "period-instead-of-a-rate", "number": number.text}
    for number in found:
        if number.value / 60 in true:
            return {"fault": "rate-per-minute", "number": number.text}
        if any(number.value * by in true for by in (1e-3, 1e3, 1e6, 1e9)):
            return {"fault": "rate-in-another-unit", "number": number.text}
    if all(map(_elapsed_numbers, summaries)):
        what = f"{_elapsed_numbers(summary)[0].text} is the time in seconds since the first message"
        return {"fault": "wrong-rate-in-the-summary", "what": what}
    leads = [[lead for _, lead in _clock_leads(other)] for other in summaries]
    for number, lead in _clock_leads(summary):
        if lead.high > MIN_LEAD_S and all(any(_may_be_same(lead, other) for other in possible) for possible in leads):
            return {"fault": "counted-from-the-nodes-start", "number": number.text, "lead_s": lead.high}
    if all(map(_find_whole_seconds, summaries)):
        number, whole_s = _find_whole_seconds(summary)[0]
        covered = covered_count(summary)
        return {"fault": "seconds-cut-off", "number": number.text, "covered": covered, "whole_s": whole_s}
    if not found:
        return {"fault": "no-rate"}
    texts = ", ".join(number.text for number in found)
    what = f"none of {texts} is the rate" if len(found) > 1 else f"{texts} is not the rate"
    return {"fault": "wrong-rate-in-the-summary", "what": what}


def _elapsed_numbers(summary: Summary) -> list[Number]:
    """The numbers that are the seconds from the first message to the summary."""
    span = elapsed_s(summary, covered_count(summary))
    return [
        number for number in numbers_except_count(summary) if span.low - DELAY_S <= number.value <= span.high + DELAY_S
    ]


def _find_whole_seconds(summary: Summary) -> list[tuple[Number, int]]:
    """The numbers that are the messages per whole seconds, with that number of seconds."""
    count = covered_count(summary)
    span = elapsed_s(summary, count)
    return [
        (number, whole_s)
        for number in numbers_except_count(summary)
        for whole_s in {max(int(span.low), 1), max(int(span.high), 1)}
        if number.value > 0 and abs(count / number.value - whole_s) < WHOLE_SECONDS_ERROR_S
    ]


def _clock_leads(summary: Summary) -> list[tuple[Number, Range]]:
    """For each number, taken as a rate: how long before the first message its clock must have started."""
    count = covered_count(summary)
    read = elapsed_s(summary, count)  # the clock was read in between
    spans = ((number, count / number.value) for number in numbers_except_count(summary) if number.value > 0)
    return [(number, Range(span - read.high, span - read.low)) for number, span in spans]


def _may_be_same(one: Range, other: Range) -> bool:
    """Whether both may be the same time."""
    return one.low - other.high < SAME_TIME_S and other.low - one.high < SAME_TIME_S
