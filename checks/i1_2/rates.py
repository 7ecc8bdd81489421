"""I1.2: which rates are true, and where a summary states one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from checks.i1_2.facts import EVERY, Feeding
from checks.i1_2.reading import Number
from checks.i1_2.reports import Report, slots
from tutor.judge.rates import TOLERANCE
from tutor.judge.verdict import Cause

DELAY_S = 0.01
"""A message takes up to this long from our clock to the node's."""

FEW = 5
"""The shortest window, in messages, over which a rate is taken."""


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

    def among(self, report: Report) -> bool:
        """Whether any number in the report is one of these."""
        return any(map(self.holds, report.numbers))


def sent_hz(feeding: Feeding) -> float:
    """The rate at which the messages were sent."""
    return (len(feeding.sent) - 1) / (feeding.sent[-1].at - feeding.sent[0].at)


def true_rates(report: Report, feeding: Feeding) -> Range:
    """What may be stated: N or N-1 messages by the time since the first of them, or since a recent one.

    Where the machine let the node take in that first one late, the time seemed shorter to it by as much.
    """
    least, most = [], []
    for until in range(report.messages, report.until + 1):
        last_at = feeding.sent[until - 1].at
        for first in range(max(1, until - FEW + 1)):
            count, since = until - first, feeding.sent[first].at
            span = max(last_at - since, DELAY_S)
            delay = min(DELAY_S + feeding.delay_s(first), 0.7 * span)
            if count >= EVERY:  # as many as a summary has: since the first of them, until it is logged
                least.append((count - 1) / (max(report.at - since, span) + DELAY_S))
                most.append(count / (span - delay))
            least.append((count - 1) / (span + DELAY_S))
            most.append((count - 1) / (span - delay))
    return Range((1 - TOLERANCE) * min(least), (1 + TOLERANCE) * max(most))


def stated(reports: Sequence[Report], allowed: Sequence[Range], elsewhere: Sequence[Report]) -> list[Number] | None:
    """The true rate as each report states it, in the same place of each; None where one of them does not.

    `elsewhere`: reports of another rate. A number that is the same there is no rate.
    """
    constant = {number.text for number in elsewhere[0].numbers} if elsewhere else set()
    if (places := slots(reports)) is not None:
        others = slots([reports[0], elsewhere[0]]) if elsewhere else None
        for index, place in enumerate(places):
            same = others is not None and others[index][0].text == others[index][1].text
            if not same and all(one.holds(number) for one, number in zip(allowed, place, strict=True)):
                return list(place)
        return None
    found = []
    for report, one in zip(reports, allowed, strict=True):
        numbers = [n for n in report.numbers if one.holds(n) and (n.text not in constant or "." in n.text)]
        if not numbers:
            return None
        found.append(numbers[0])
    return found


def why_wrong(report: Report, feeding: Feeding) -> Cause:
    """What kind of mistake leads to the numbers in a report without a true rate."""
    true = true_rates(report, feeding)
    elapsed = max(report.at - feeding.sent[0].at, 0.001)
    hint = "self.total_count / (time.time() - self.start_time), where start_time is when the first message came"
    found = [number for number in report.numbers if number.value > 0 and not report_counts(number, report)]
    for number in found:
        if 1 / number.value in true:
            return Cause(
                "period instead of a rate",
                f"{number.text} are the seconds from one message to the next",
                "messages per second are messages divided by seconds, not seconds by messages",
            )
    for number in found:
        if number.value / 60 in true:
            return Cause("rate per minute", f"{number.text} is messages per minute", hint)
        if number.value / 1000 in true or number.value * 1000 in true:
            return Cause("rate in another unit", f"{number.text} is off by a factor of a thousand", hint)
    for number in found:
        since = report.messages / number.value
        if elapsed + 0.7 <= since <= report.at - feeding.trace.started_at + 0.5:
            return Cause(
                "counted from the node's start",
                f"{number.text} is {report.messages} messages in {since:.1f} s, but the first came {elapsed:.1f} s "
                "before this summary",
                "set self.start_time in the callback, when the first message comes, not in __init__",
            )
        if elapsed >= 1 and abs(number.value - report.messages / int(elapsed)) < 0.1:
            return Cause(
                "seconds cut off",
                f"{number.text} is {report.messages} messages in {int(elapsed)} s, but it took {elapsed:.1f} s",
                "keep the elapsed time as a float: no int(), and no //",
            )
    if not found:
        return Cause("no rate", "there is no other number than the count in it", hint)
    return Cause("wrong rate", f"none of {', '.join(number.text for number in found)} is the rate", hint)


def report_counts(number: Number, report: Report) -> bool:
    """Whether this is the number of messages, which is no rate."""
    return number.value == report.messages
