"""I1.2: the true rates, and where a summary states one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import inf

from checks.i1_2.facts import STALL_S, SUMMARY_EVERY, Trial
from checks.i1_2.faults import Fault
from checks.i1_2.reading import Number
from checks.i1_2.summaries import Summary, find_summaries, last_due_count, possible_totals, slots
from tutor.judge.rates import TOLERANCE

DELAY_S = 0.01
"""Maximum latency of a message on an idle machine."""

CLOSE_TOLERANCE = 0.05
"""Relative error of a node that measures well."""
SLOWEST_S = 1.97
"""If the first ten messages take longer than this to send, they were not sent at the planned rate."""

MIN_WINDOW = 5
"""The shortest window, in messages, over which a rate may be measured."""

WHOLE_SECONDS_ERROR_S = 0.01
"""Maximum deviation from whole seconds of the time that a rate implies: rates are often written with two digits."""

SAME_TIME_S = 0.2
"""Maximum difference between two of our time measurements that count as equal."""


@dataclass(frozen=True, slots=True)
class Range:
    """The true rates, including the tolerance, in messages per second."""

    low: float
    high: float

    def __contains__(self, hz: float) -> bool:
        return self.low <= hz <= self.high

    def holds(self, number: Number) -> bool:
        """Whether the number, in any of its readings, is in the range."""
        return any(value in self for value in number.values)

    def among(self, summary: Summary) -> bool:
        """Whether any number in the summary is in the range."""
        return any(map(self.holds, summary.numbers))


def sent_hz(trial: Trial) -> float:
    """The rate at which the messages were sent."""
    return (len(trial.sent) - 1) / (trial.sent[-1].at - trial.sent[0].at)


def true_rates(summary: Summary, trial: Trial, *, excused_s: float = inf) -> Range:
    """The rates that may be stated: N or N-1 messages divided by the time since the first, or since a recent one.

    If the machine delayed that message's callback, the time seems shorter to the node by the same amount; at most
    `excused_s` of that is allowed for.
    """
    least, most = [], []
    for until in range(summary.messages, summary.messages_at_end + 1):
        last_at = trial.sent[until - 1].at
        for first in range(max(1, until - MIN_WINDOW + 1)):
            count, since = until - first, trial.sent[first].at
            span = max(last_at - since, DELAY_S)
            delay = min(DELAY_S + min(trial.delay_s(first), excused_s), 0.7 * span)
            if count >= SUMMARY_EVERY or first == 0:  # from the first message until the summary is logged
                least.append((count - 1) / (max(summary.at - since, span) + DELAY_S))
                most.append(count / (span - delay))
            least.append((count - 1) / (span + DELAY_S))
            most.append((count - 1) / (span - delay))
    return Range((1 - TOLERANCE) * min(least), (1 + TOLERANCE) * max(most))


def find_stated_rates(summaries: Sequence[Summary], allowed: Sequence[Range], jump: Trial) -> list[Number] | None:
    """The true rate as stated by each summary, in the same place of each; None if one does not state it.

    `jump` was fed at another rate: a number that is the same, and wrong, in all of its summaries is not a rate. One
    summary is not enough: a rate measured over the first few messages may happen to be the same.
    """
    elsewhere = find_summaries(jump)
    wrong_numbers = [{n.text for n in each.numbers if not true_rates(each, jump).holds(n)} for each in elsewhere]
    constant = set.intersection(*wrong_numbers) if wrong_numbers else set()
    if (places := slots(summaries)) is not None:
        others = slots([summaries[0], *elsewhere]) or places
        for place, other in zip(places, others, strict=True):
            same = len({number.text for number in other}) == 1 and other[0].text in constant
            if not same and all(one.holds(number) for one, number in zip(allowed, place, strict=True)):
                return list(place)
        return None
    found = []
    for summary, one in zip(summaries, allowed, strict=True):
        numbers = [number for number in summary.numbers if one.holds(number) and number.text not in constant]
        if not numbers:
            return None
        found.append(numbers[0])
    return found


def is_doubtful_rate(numbers: Sequence[Number], summaries: Sequence[Summary], trial: Trial) -> bool:
    """Whether these numbers may only look like the rate, because a busy machine kept us from the planned send rate.

    At the planned rate, other numbers are far from it: the elapsed seconds, the messages per whole seconds, or per
    seconds since the start of the node.
    """
    strict = [true_rates(summary, trial, excused_s=STALL_S) for summary in summaries]
    true = all(one.holds(number) for one, number in zip(strict, numbers, strict=True))
    late = trial.allowance_s > STALL_S and any(_lateness(summary, trial) > STALL_S for summary in summaries)
    if true and not late and _elapsed(summaries[0], trial) <= SLOWEST_S and trial.delay_s(0) <= STALL_S:
        return False
    sent_s = [_elapsed(summary, trial) for summary in summaries]
    logged_s = [span + max(_lateness(summary, trial), 0.0) for summary, span in zip(summaries, sent_s, strict=True)]
    whole = [
        [summary.messages / max(int(span), 1) for summary, span in zip(summaries, elapsed_s, strict=True)]
        for elapsed_s in (sent_s, logged_s)
    ]
    explained_otherwise = any(
        all(abs(number.value - other) < 0.01 + DELAY_S * other for number, other in zip(numbers, others, strict=True))
        for others in (sent_s, logged_s, *whole)
    )
    return explained_otherwise or not all(
        any(close.holds(number) for close in _well_measured(summary, trial))
        for number, summary in zip(numbers, summaries, strict=True)
    )


def _elapsed(summary: Summary, trial: Trial) -> float:
    """Seconds from the first message to the one at which the summary was due."""
    count = last_due_count(summary.messages) or summary.messages
    return max(trial.sent[count - 1].at - trial.sent[0].at, DELAY_S)


def _lateness(summary: Summary, trial: Trial) -> float:
    """Seconds from the message at which the summary was due to its first line."""
    count = last_due_count(summary.messages) or summary.messages
    return summary.at - trial.sent[count - 1].at


def _well_measured(summary: Summary, trial: Trial) -> Iterator[Range]:
    """The rates of a node that measures well: since the first message, or over the last ten."""
    for first in {0, max(0, (last_due_count(summary.messages) or summary.messages) - SUMMARY_EVERY)}:
        since = trial.sent[first].at
        soonest = trial.sent[max(first, (last_due_count(summary.messages) or summary.messages) - 1)].at - since
        delay = min(trial.delay_s(first), 0.7 * soonest)
        low = (summary.messages - first - 1) / max(summary.at - since, DELAY_S)
        high = (summary.messages - first) / max(soonest - delay, DELAY_S)
        yield Range((1 - CLOSE_TOLERANCE) * low, (1 + CLOSE_TOLERANCE) * high)


def find_wrong_rate(summary: Summary, summaries: Sequence[Summary], trial: Trial) -> Fault:
    """What the numbers in `summary`, which states no true rate, are instead."""
    found = numbers_except_count(summary, trial)
    true = true_rates(summary, trial)
    for number in found:
        if number.value > 0 and 1 / number.value in true:
            return {"fault": "period-instead-of-a-rate", "number": number.text}
    for number in found:
        if number.value / 60 in true:
            return {"fault": "rate-per-minute", "number": number.text}
        if any(number.value * by in true for by in (1e-3, 1e3, 1e6, 1e9)):
            return {"fault": "rate-in-another-unit", "number": number.text}
    elapsed = [_elapsed_numbers(each, trial) for each in summaries]
    if all(elapsed):
        number = _elapsed_numbers(summary, trial)[0]
        return {
            "fault": "wrong-rate-in-the-summary",
            "what": f"{number.text} is the time in seconds since the first message",
        }
    waited = [_clock_lead(each, trial) for each in summaries]
    for number, span in _clock_lead(summary, trial):
        if span.high > 0.7 and all(any(span.meets(same) for _, same in each) for each in waited):
            return {"fault": "counted-from-the-nodes-start", "number": number.text, "lead_s": span.high}
    if all(_find_whole_seconds(each, trial) for each in summaries):
        number, whole_s = _find_whole_seconds(summary, trial)[0]
        covered = _covered_count(summary, trial)
        return {"fault": "seconds-cut-off", "number": number.text, "covered": covered, "whole_s": whole_s}
    if not found:
        return {"fault": "no-rate"}
    texts = ", ".join(number.text for number in found)
    return {
        "fault": "wrong-rate-in-the-summary",
        "what": f"none of {texts} is the rate" if len(found) > 1 else f"{texts} is not the rate",
    }


def _elapsed_numbers(summary: Summary, trial: Trial) -> list[Number]:
    """The numbers that are the seconds from the first message to the summary."""
    count, since = _covered_count(summary, trial), trial.sent[0].at
    soonest, latest = trial.sent[count - 1].at - since, summary.at - since
    return [
        each for each in numbers_except_count(summary, trial) if soonest - DELAY_S <= each.value <= latest + DELAY_S
    ]


def _find_whole_seconds(summary: Summary, trial: Trial) -> list[tuple[Number, int]]:
    """The numbers that are the messages per whole seconds, with that number of seconds."""
    count, since = _covered_count(summary, trial), trial.sent[0].at
    spans = {max(int(at - since), 1) for at in (trial.sent[count - 1].at, summary.at)}
    positive = [number for number in numbers_except_count(summary, trial) if number.value > 0]
    return [
        (number, span)
        for number in positive
        for span in spans
        if abs(count / number.value - span) < WHOLE_SECONDS_ERROR_S
    ]


@dataclass(frozen=True, slots=True)
class _Span:
    """The bounds of an uncertain time, in seconds."""

    low: float
    high: float

    def meets(self, other: _Span) -> bool:
        """Whether both may be the same time."""
        return self.low - other.high < SAME_TIME_S and other.low - self.high < SAME_TIME_S


def _clock_lead(summary: Summary, trial: Trial) -> list[tuple[Number, _Span]]:
    """For each number, taken as a rate: how long before the first message its clock must have started.

    The clock was read between the arrival of the last counted message and the logging of the summary.
    """
    count, since = _covered_count(summary, trial), trial.sent[0].at
    soonest, latest = trial.sent[count - 1].at - since, summary.at - since
    spans = ((number, count / number.value) for number in numbers_except_count(summary, trial) if number.value > 0)
    return [(number, _Span(span - latest, span - soonest)) for number, span in spans]


def _covered_count(summary: Summary, trial: Trial) -> int:
    """The number of messages that the summary covers: the true total that it states, or all that had been sent."""
    return next((total for total in possible_totals(summary, trial) if summary.states(total)), summary.messages)


def numbers_except_count(summary: Summary, trial: Trial) -> list[Number]:
    """The numbers in the summary, except its count."""
    covered = _covered_count(summary, trial)
    count = next((number for number in summary.numbers if number.value == covered), None)
    return [number for number in summary.numbers if number is not count]
