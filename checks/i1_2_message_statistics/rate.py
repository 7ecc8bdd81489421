"""I1.2: the true rates, where a summary states one, and the verdict on `rate`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import inf

from checks.i1_2_message_statistics.count import Fault, fails, swapped, total_as_rate, unless_messages_are_lost
from checks.i1_2_message_statistics.log_lines import Number
from checks.i1_2_message_statistics.logged_summaries import NO_SUMMARY, Summary, find_summaries, possible_totals, slots
from checks.i1_2_message_statistics.plans import RESTARTED_HZ
from checks.i1_2_message_statistics.trial import STALL_S, SUMMARY_EVERY, Trial
from tutor.judge.rates import TOLERANCE
from tutor.judge.verdict import Verdict, passed, skipped, undecided

DELAY_S = 0.01
"""Maximum latency of a message on an idle machine."""

CLOSE_TOLERANCE = 0.05
"""Relative error of a node that measures well."""
SLOWEST_S = 1.97
"""If the first ten messages take longer than this to send, they were not sent at the planned rate."""

MIN_WINDOW = 5
"""The shortest window, in messages, over which a rate may be measured."""


@unless_messages_are_lost
def judge_rate(steady: Trial, jump: Trial, restart: Trial, fast: Trial) -> Verdict:
    """Judge `rate`. `restart`: a run in which the rate changes."""
    summaries = [summary for summary in find_summaries(steady) if summary.messages > 1]  # one message gives no rate yet
    if not summaries:
        return skipped(NO_SUMMARY)
    allowed = [true_rates(summary) for summary in summaries]
    low, high = min(rates.low for rates in allowed), max(rates.high for rates in allowed)
    expected = f"each summary states the messages per second: {sent_hz(steady):.2f}, from {low:.1f} to {high:.1f}"
    stated = find_stated_rates(summaries, jump)
    if stated is None:
        wrong = next(
            (summary for summary, true in zip(summaries, allowed, strict=True) if not true.among(summary)),
            summaries[-1],
        )
        fault: Fault = {"fault": "wrong-rate", "summary": wrong, "summaries": summaries}
        return fails(expected, _describe_numbers(wrong), steady, fault)
    if all(map(total_as_rate, summaries)):
        return fails(expected, _describe_numbers(summaries[-1]), steady, swapped(summaries[-1]))
    if is_undecided(stated, summaries):
        return undecided("to send messages at an even rate")
    if (kept := find_kept_rate(restart)) is not None:
        return fails(
            "each summary states the messages per second, also when they change",
            f"{kept.text} at first, and still {kept.text} when another talker sends {RESTARTED_HZ:g} a second",
            restart,
            {"fault": "rate-never-updated", "rate": kept.text},
        )
    observed = f"{', '.join(number.text for number in stated)} messages per second"
    return passed(expected, observed, map(str, summaries))


def _describe_numbers(summary: Summary) -> str:
    numbers = ", ".join(number.text for number in summary.numbers)
    return f"after {summary.messages} messages it states {numbers or 'no number'}"


@dataclass(frozen=True, slots=True)
class Range:
    """The bounds of what may be true: of a rate in messages per second, or of a time in seconds."""

    low: float
    high: float

    def __contains__(self, value: float) -> bool:
        return self.low <= value <= self.high

    def widened(self, share: float) -> Range:
        """The range with this share of tolerance on both sides."""
        return Range((1 - share) * self.low, (1 + share) * self.high)

    def holds(self, number: Number) -> bool:
        """Whether the number, in any of its readings, is in the range."""
        return any(value in self for value in number.values)

    def among(self, summary: Summary) -> bool:
        """Whether any number in the summary is in the range."""
        return any(map(self.holds, summary.numbers))


def sent_hz(trial: Trial) -> float:
    """The rate at which the messages were sent."""
    return (len(trial.sent) - 1) / (trial.sent[-1].at - trial.sent[0].at)


def true_rates(summary: Summary, *, allowance_s: float = inf) -> Range:
    """The rates that may be stated: N or N-1 messages divided by the time since the first, or since a recent one.

    If the machine delayed that message's callback, the time seems shorter to the node by the same amount; the
    allowance for that is at most `allowance_s`.
    """
    trial = summary.trial
    least, most = [], []
    for until in range(summary.messages, summary.messages_at_end + 1):
        last_at = trial.sent[until - 1].at
        for first in range(max(1, until - MIN_WINDOW + 1)):
            count, since = until - first, trial.sent[first].at
            span = max(last_at - since, DELAY_S)
            delay = min(DELAY_S + min(trial.delay_s(first), allowance_s), 0.7 * span)
            if count >= SUMMARY_EVERY or first == 0:  # from the first message until the summary is logged
                least.append((count - 1) / (max(summary.at - since, span) + DELAY_S))
                most.append(count / (span - delay))
            least.append((count - 1) / (span + DELAY_S))
            most.append((count - 1) / (span - delay))
    return Range(min(least), max(most)).widened(TOLERANCE)


def find_stated_rates(summaries: Sequence[Summary], jump: Trial) -> list[Number] | None:
    """The true rate as stated by each summary, in the same place of each; None if one does not state it.

    `jump` was fed at another rate: a number that is the same, and wrong, in all of its summaries is not a rate. One
    summary is not enough: a rate measured over the first few messages may happen to be the same.
    """
    allowed = [true_rates(summary) for summary in summaries]
    elsewhere = find_summaries(jump)
    wrong_numbers = [{n.text for n in summary.numbers if not true_rates(summary).holds(n)} for summary in elsewhere]
    constant = set.intersection(*wrong_numbers) if wrong_numbers else set()
    if (places := slots(summaries)) is not None:
        others = slots([summaries[0], *elsewhere]) or places
        for place, other in zip(places, others, strict=True):
            same = len({number.text for number in other}) == 1 and other[0].text in constant
            if not same and all(one.holds(number) for one, number in zip(allowed, place, strict=True)):
                return list(place)
        return None
    found = [
        [number for number in summary.numbers if one.holds(number) and number.text not in constant]
        for summary, one in zip(summaries, allowed, strict=True)
    ]
    return [numbers[0] for numbers in found] if all(found) else None


def find_kept_rate(restart: Trial) -> Number | None:
    """The rate that a node states before and after the publisher is replaced by one of another rate.

    A rate of any of the messages has changed by then. None if it also states another true rate, or if the rate has no
    decimals, and so may be the same by chance.
    """
    summaries = find_summaries(restart)
    before = [summary for summary in summaries if summary.messages <= restart.before_break]
    after = [summary for summary in summaries if summary.messages >= restart.before_break + MIN_WINDOW]
    for number in before[0].numbers if before and after else ():
        kept = all(number.text in {other.text for other in summary.numbers} for summary in (*before, *after))
        if "." in number.text and kept and true_rates(before[0]).holds(number):
            others = (
                other
                for summary in after
                for other in numbers_except_count(summary)
                if true_rates(summary).holds(other)
            )
            return number if all(other.text == number.text for other in others) else None
    return None


def is_undecided(numbers: Sequence[Number], summaries: Sequence[Summary]) -> bool:
    """Whether these numbers may only look like the rate, because the machine kept us from the planned send rate.

    At the planned rate, other numbers are far from it: the elapsed seconds, the messages per whole seconds, or per
    seconds since the start of the node.
    """
    trial, stated = summaries[0].trial, list(zip(numbers, summaries, strict=True))
    elapsed = [elapsed_s(summary, summary.due or summary.messages) for summary in summaries]
    true = all(true_rates(summary, allowance_s=STALL_S).holds(number) for number, summary in stated)
    late = trial.allowance_s > STALL_S and any(span.high - span.low > STALL_S for span in elapsed)
    if true and not late and elapsed[0].low <= SLOWEST_S and trial.delay_s(0) <= STALL_S:
        return False
    times = [span.low for span in elapsed], [span.high for span in elapsed]
    whole = [
        [summary.messages / max(int(span), 1) for summary, span in zip(summaries, at, strict=True)] for at in times
    ]
    explained_otherwise = any(
        all(abs(number.value - other) < 0.01 + DELAY_S * other for number, other in zip(numbers, others, strict=True))
        for others in (*times, *whole)
    )
    measured = all(any(close.holds(number) for close in _well_measured(summary)) for number, summary in stated)
    return explained_otherwise or not measured


def elapsed_s(summary: Summary, count: int, first: int = 0) -> Range:
    """The seconds from the first message, or a later one, until this many had been sent, and until it was logged."""
    sent = summary.trial.sent
    low = sent[max(first, count - 1)].at - sent[first].at
    return Range(low, max(summary.at - sent[first].at, low, DELAY_S))


def _well_measured(summary: Summary) -> Iterator[Range]:
    """The rates of a node that measures well: since the first message, or over the last ten."""
    last = summary.due or summary.messages
    for first in {0, max(0, last - SUMMARY_EVERY)}:
        elapsed, count = elapsed_s(summary, last, first), summary.messages - first
        delay = min(summary.trial.delay_s(first), 0.7 * elapsed.low)
        yield Range((count - 1) / elapsed.high, count / max(elapsed.low - delay, DELAY_S)).widened(CLOSE_TOLERANCE)


def covered_count(summary: Summary) -> int:
    """The number of messages that the summary covers: the true total that it states, or all that had been sent."""
    return next(filter(summary.states, possible_totals(summary)), summary.messages)


def numbers_except_count(summary: Summary) -> list[Number]:
    """The numbers in the summary, except its count."""
    covered = covered_count(summary)
    count = next((number for number in summary.numbers if number.value == covered), None)
    return [number for number in summary.numbers if number is not count]
