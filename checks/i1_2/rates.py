"""I1.2: which rates are true, and where a summary states one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import inf

from checks.i1_2 import steps
from checks.i1_2.facts import EVERY, STALL_S, Trial
from checks.i1_2.reading import Number
from checks.i1_2.summaries import Summary, find_summaries, milestone, slots, totals
from tutor.judge.rates import TOLERANCE
from tutor.judge.verdict import Cause

DELAY_S = 0.01
"""A message takes up to this long from our clock to the node's."""

CLOSE = 0.05
SLOWEST_S = 1.97
"""The first ten messages are sent within this time, or the pace was not the one that was planned."""

FEW = 5
"""The shortest window, in messages, over which a rate is taken."""

CUT_S = 0.01
"""A rate is one by whole seconds if it makes them whole by this much: it is often written with two digits."""

SAME_S = 0.2
"""Two times that are measured from here are the same if they differ by less."""


@dataclass(frozen=True, slots=True)
class Range:
    """The rates that are true, the tolerance included: messages per second."""

    low: float
    high: float

    def __contains__(self, hz: float) -> bool:
        return self.low <= hz <= self.high

    def holds(self, number: Number) -> bool:
        """Whether the number may be meant as one of these."""
        return any(value in self for value in number.values)

    def among(self, summary: Summary) -> bool:
        """Whether any number in the summary is one of these."""
        return any(map(self.holds, summary.numbers))


def sent_hz(trial: Trial) -> float:
    """The rate at which the messages were sent."""
    return (len(trial.sent) - 1) / (trial.sent[-1].at - trial.sent[0].at)


def true_rates(summary: Summary, trial: Trial, *, excused_s: float = inf) -> Range:
    """What may be stated: N or N-1 messages by the time since the first of them, or since a recent one.

    Where the machine let the node take in that first one late, the time seemed shorter to it by as much, or by
    `excused_s` at most.
    """
    least, most = [], []
    for until in range(summary.messages, summary.until + 1):
        last_at = trial.sent[until - 1].at
        for first in range(max(1, until - FEW + 1)):
            count, since = until - first, trial.sent[first].at
            span = max(last_at - since, DELAY_S)
            delay = min(DELAY_S + min(trial.delay_s(first), excused_s), 0.7 * span)
            if count >= EVERY or first == 0:  # since the first of them, until it is logged
                least.append((count - 1) / (max(summary.at - since, span) + DELAY_S))
                most.append(count / (span - delay))
            least.append((count - 1) / (span + DELAY_S))
            most.append((count - 1) / (span - delay))
    return Range((1 - TOLERANCE) * min(least), (1 + TOLERANCE) * max(most))


def stated(summaries: Sequence[Summary], allowed: Sequence[Range], jump: Trial) -> list[Number] | None:
    """The true rate as each summary states it, in the same place of each; None where one of them does not.

    `jump` was fed at another rate: a number that is the same there each time, and not true there, is not a rate. Once
    is not enough: a rate that was taken a while ago, when the first messages had just come, may happen to be the same.
    """
    elsewhere = find_summaries(jump)
    untrue = [{n.text for n in each.numbers if not true_rates(each, jump).holds(n)} for each in elsewhere]
    constant = set.intersection(*untrue) if untrue else set()
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


def doubtful(numbers: Sequence[Number], summaries: Sequence[Summary], trial: Trial) -> bool:
    """Whether these may only seem to be the rate, because a busy machine did not let us send at the pace planned.

    At that pace, what is not the rate is far from it: the elapsed seconds, the messages by whole seconds, or by the
    seconds since the node was started.
    """
    sure = [true_rates(summary, trial, excused_s=STALL_S) for summary in summaries]
    true = all(one.holds(number) for one, number in zip(sure, numbers, strict=True))
    if true and _elapsed(summaries[0], trial) <= SLOWEST_S and trial.delay_s(0) <= STALL_S:
        return False
    elapsed = [_elapsed(summary, trial) for summary in summaries]
    whole = [summary.messages / max(int(span), 1) for summary, span in zip(summaries, elapsed, strict=True)]
    seeming = any(
        all(abs(number.value - other) < 0.01 + DELAY_S * other for number, other in zip(numbers, others, strict=True))
        for others in (elapsed, whole)
    )
    return seeming or not all(
        any(close.holds(number) for close in _close(summary, trial))
        for number, summary in zip(numbers, summaries, strict=True)
    )


def _elapsed(summary: Summary, trial: Trial) -> float:
    """Seconds from the first message to the one that the summary is due for."""
    count = milestone(summary.messages) or summary.messages
    return max(trial.sent[count - 1].at - trial.sent[0].at, DELAY_S)


def _close(summary: Summary, trial: Trial) -> Iterator[Range]:
    """What a node that measures well comes to: since the first message, or since the last but nine."""
    for first in {0, max(0, (milestone(summary.messages) or summary.messages) - EVERY)}:
        since = trial.sent[first].at
        soonest = trial.sent[max(first, (milestone(summary.messages) or summary.messages) - 1)].at - since
        delay = min(trial.delay_s(first), 0.7 * soonest)
        low = (summary.messages - first - 1) / max(summary.at - since, DELAY_S)
        high = (summary.messages - first) / max(soonest - delay, DELAY_S)
        yield Range((1 - CLOSE) * low, (1 + CLOSE) * high)


def diagnose_wrong_rate(summary: Summary, summaries: Sequence[Summary], trial: Trial) -> Cause:
    """What kind of mistake leads to the numbers in this one of the summaries, which states no true rate."""
    found = _but_the_count(summary, trial)
    texts, numbers = [line.text for line in summary.lines], [number.text for number in found]
    hint = steps.measure_rate(trial.trace, texts, numbers) or (
        "self.total_count / (time.time() - self.start_time), where start_time is when the first message came"
    )
    true = true_rates(summary, trial)
    for number in found:
        if number.value > 0 and 1 / number.value in true:
            return Cause(
                "period instead of a rate",
                f"{number.text} are the seconds from one message to the next",
                hint,
            )
    for number in found:
        if number.value / 60 in true:
            return Cause("rate per minute", f"{number.text} is messages per minute", hint)
        if any(number.value * by in true for by in (1e-3, 1e3, 1e6, 1e9)):
            return Cause("rate in another unit", f"{number.text} is off by a factor of a thousand, or of several", hint)
    waited = [_waited(each, trial) for each in summaries]
    for number, span in _waited(summary, trial):
        if span.high > 0.7 and all(any(span.meets(same) for _, same in each) for each in waited):
            return Cause(
                "counted from the node's start",
                f"{number.text} is right if the clock starts {span.high:.1f} s before the first message",
                hint,
            )
    if all(_cut(each, trial) for each in summaries):
        number, whole_s = _cut(summary, trial)[0]
        return Cause(
            "seconds cut off",
            f"{number.text} is {_count(summary, trial)} messages in {whole_s} s, but it took longer",
            hint,
        )
    if not found:
        return Cause("no rate", "there is no other number than the count in it", hint)
    return Cause("wrong rate", f"none of {', '.join(number.text for number in found)} is the rate", hint)


def _cut(summary: Summary, trial: Trial) -> list[tuple[Number, int]]:
    """The numbers that are its messages by whole seconds, and how many these are."""
    count, since = _count(summary, trial), trial.sent[0].at
    spans = {max(int(at - since), 1) for at in (trial.sent[count - 1].at, summary.at)}
    positive = [number for number in _but_the_count(summary, trial) if number.value > 0]
    return [(number, span) for number in positive for span in spans if abs(count / number.value - span) < CUT_S]


@dataclass(frozen=True, slots=True)
class _Span:
    """A time in seconds, as far as it is known."""

    low: float
    high: float

    def meets(self, other: _Span) -> bool:
        """Whether both may be the same."""
        return self.low - other.high < SAME_S and other.low - self.high < SAME_S


def _waited(summary: Summary, trial: Trial) -> list[tuple[Number, _Span]]:
    """For each number, if it were a rate: how long before the first message the clock was started.

    The node stopped it when the last message that it counts came, or when it wrote the summary, or in between.
    """
    count, since = _count(summary, trial), trial.sent[0].at
    soonest, latest = trial.sent[count - 1].at - since, summary.at - since
    spans = ((number, count / number.value) for number in _but_the_count(summary, trial) if number.value > 0)
    return [(number, _Span(span - latest, span - soonest)) for number, span in spans]


def _count(summary: Summary, trial: Trial) -> int:
    """How many messages it is made of: the true total that it states, or all that had come."""
    return next((total for total in totals(summary, trial) if summary.states(total)), summary.messages)


def _but_the_count(summary: Summary, trial: Trial) -> list[Number]:
    """The numbers in the summary, without the one that is its count."""
    made_of = _count(summary, trial)
    count = next((number for number in summary.numbers if number.value == made_of), None)
    return [number for number in summary.numbers if number is not count]
