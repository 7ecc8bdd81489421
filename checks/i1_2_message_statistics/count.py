"""I1.2: the verdict on `count`: the summaries state the true total."""

from __future__ import annotations

from checks.i1_2_message_statistics.losses import find_lost, of_what_comes, renews_subscription, was_sent_fast_enough
from checks.i1_2_message_statistics.plans import FAST_HZ
from checks.i1_2_message_statistics.summaries import Summary, find_summaries, possible_totals
from checks.i1_2_message_statistics.summary import NO_SUMMARY, fast_summaries
from checks.i1_2_message_statistics.totals import (
    fails,
    find_wrong_count,
    in_words,
    may_lack_lost_messages,
    swapped,
    total_as_rate,
    true_total,
)
from checks.i1_2_message_statistics.trial import CHATTER, SUMMARY_EVERY, Trial
from tutor.judge.verdict import Verdict, passed, skipped, undecided

EXPECTED = "each summary states how many messages have come"


@of_what_comes
def judge_count(steady: Trial, jump: Trial, fast: Trial) -> Verdict:
    """Judge `count`."""
    if not find_summaries(steady):
        return skipped(NO_SUMMARY)
    if renewing := next(filter(renews_subscription, (steady, fast)), None):
        renewals = renewing.new_subscriptions
        observed = f"{renewals} new subscriptions on {CHATTER.name} while {len(renewing.sent)} messages came"
        return fails(EXPECTED, observed, renewing, {"renewals": renewals})
    verdict = _judge_slow(steady, jump)
    if not verdict.passed:
        return verdict
    lost = find_lost(fast, steady)
    if lost.excused if lost else not was_sent_fast_enough(fast):
        return undecided("to send messages fast")
    if lost is None:
        return verdict
    return fails(
        f"{EXPECTED}, at {FAST_HZ:g} a second, too",
        f"{lost.counted} messages up to the last that it quotes; {lost.summary}",
        fast,
        {"fault": "cannot-keep-up", "counted": lost.counted},
    )


def _judge_slow(steady: Trial, jump: Trial) -> Verdict:
    """Judge the totals of messages that come slowly."""
    seen = [*find_summaries(steady), *find_summaries(jump)]
    evidence = [str(summary) for summary in seen]
    wrong = [summary for summary in seen if not true_total(summary)]
    if 0 < len(wrong) < len(seen) and all(map(may_lack_lost_messages, wrong)):
        return undecided("to tell whether the node lost messages")
    if wrong:
        last = wrong[-1]  # after the jump, N and the count differ most, so that the cause is clearest
        expected = f"{EXPECTED}: {in_words(possible_totals(last))}"
        return fails(expected, _says_otherwise(last), last.trial, find_wrong_count(last), evidence)
    if all(map(total_as_rate, seen)):
        return fails(EXPECTED, _says_otherwise(seen[-1]), seen[-1].trial, swapped(seen[-1]), evidence)
    stated = ", ".join(str(true_total(summary)) for summary in seen)
    return passed(EXPECTED, f"{len(seen)} summaries state {stated}", evidence)


@of_what_comes
def judge_fast_count(fast: Trial) -> Verdict | None:
    """Judge `count` by the fast stretch alone: fail if no summary states anything like the true total.

    A total that a lagging node may state, or one whose summary waits for a timer, is not held against it.
    """
    summaries = fast_summaries(fast)
    if not summaries or not all(summary.is_complete for summary in summaries):
        return None
    for summary in summaries:
        lagging = range(SUMMARY_EVERY, summary.messages_at_end + 1, SUMMARY_EVERY)
        if any(map(summary.states, (*lagging, *possible_totals(summary)))):
            return None
    last = summaries[-1]
    expected = f"{EXPECTED}: {in_words(possible_totals(last))}"
    return fails(expected, _says_otherwise(last), fast, find_wrong_count(last))


def _says_otherwise(summary: Summary) -> str:
    return f"the summary that came after {summary.messages} messages does not say so"
