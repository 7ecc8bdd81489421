"""I1.2: the verdict on `rate`: the summaries state the true rate of the messages."""

from __future__ import annotations

from checks.i1_2_message_statistics import rates
from checks.i1_2_message_statistics.losses import unless_messages_are_lost
from checks.i1_2_message_statistics.plans import RESTARTED_HZ
from checks.i1_2_message_statistics.summaries import Summary, find_summaries
from checks.i1_2_message_statistics.summary import NO_SUMMARY
from checks.i1_2_message_statistics.totals import fails, swapped, total_as_rate
from checks.i1_2_message_statistics.trial import Trial
from tutor.judge.verdict import Verdict, passed, skipped, undecided


@unless_messages_are_lost
def judge_rate(steady: Trial, jump: Trial, restart: Trial, fast: Trial) -> Verdict:
    """Judge `rate`. `restart`: a run in which the rate changes."""
    summaries = [summary for summary in find_summaries(steady) if summary.messages > 1]  # one message gives no rate yet
    if not summaries:
        return skipped(NO_SUMMARY)
    allowed = [rates.true_rates(summary) for summary in summaries]
    low, high = min(each.low for each in allowed), max(each.high for each in allowed)
    expected = f"each summary states the messages per second: {rates.sent_hz(steady):.2f}, from {low:.1f} to {high:.1f}"
    stated = rates.find_stated_rates(summaries, jump)
    if stated is None:
        wrong = next(
            (each for each, true in zip(summaries, allowed, strict=True) if not true.among(each)), summaries[-1]
        )
        return fails(expected, _describe_numbers(wrong), steady, rates.find_wrong_rate(wrong, summaries))
    if all(map(total_as_rate, summaries)):
        return fails(expected, _describe_numbers(summaries[-1]), steady, swapped(summaries[-1]))
    if rates.is_doubtful_rate(stated, summaries):
        return undecided("to send messages at an even rate")
    if (kept := rates.find_kept_rate(restart)) is not None:
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
