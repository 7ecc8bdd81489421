"""I1.2: the true total, whether a summary states it, and the verdict on `count`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any

from checks.i1_2_message_statistics.log_lines import Number
from checks.i1_2_message_statistics.logged_summaries import NO_SUMMARY, Summary, find_summaries, possible_totals
from checks.i1_2_message_statistics.losses import (
    fast_summaries,
    find_lost,
    of_what_comes,
    renews_subscription,
    was_sent_fast_enough,
)
from checks.i1_2_message_statistics.plans import FAST_HZ
from checks.i1_2_message_statistics.trial import CHATTER, SHOWN, SUMMARY_EVERY, Trial
from tutor.judge.symptom import Symptom
from tutor.judge.verdict import Verdict, failed, passed, skipped, undecided

EXPECTED = "each summary states how many messages have come"

Fault = dict[str, Any]
"""What is wrong with a log, as the catalogue wants to know it: `fault`, the mistake that the judges name, and words."""


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
    if lost.slowed if lost else not was_sent_fast_enough(fast):
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


def unless_messages_are_lost(judge: Callable[..., Verdict]) -> Callable[..., Verdict]:
    """Decorate a judge of trials, the first of them steady and the last one fast, of a node that keeps all messages.

    Whether a node that loses messages by design, whatever the machine, loses one particular message is luck: so only
    `count` is judged of it.
    """

    @wraps(judge)
    @of_what_comes
    def judged(*trials: Trial) -> Verdict:
        steady, fast = trials[0], trials[-1]
        if find_summaries(steady) and _is_certain_to_lose(steady, fast):
            return skipped("not judged, because the node loses messages: see `count`")
        return judge(*trials)

    return judged


def _is_certain_to_lose(steady: Trial, fast: Trial) -> bool:
    """Whether the node is certain to lose messages that are sent fast, or at any rate."""
    if renews_subscription(steady) or renews_subscription(fast):
        return True
    lost = find_lost(fast, steady) if counts_truly(steady) else None
    return lost is not None and not lost.slowed


def fails(expected: str, observed: str, trial: Trial, fault: Fault, evidence: Sequence[str] = ()) -> Verdict:
    """Fail a node whose log says something that is not so. `evidence`: by default, its summaries."""
    shown = evidence or [str(summary) for summary in find_summaries(trial)]
    return failed(expected, observed, trial.seen(Symptom.WRONG_LOG, **fault), shown[:SHOWN])


def counts_truly(*trials: Trial) -> bool:
    """Whether every summary states the true total."""
    return all(true_total(summary) for trial in trials for summary in find_summaries(trial))


def true_total(summary: Summary, *, before: int = 0) -> int:
    """The true total that a summary states, if the first `before` messages do not count; 0 if it states none.

    A summary that is logged later than its message must not quote a newer one; which older message it quotes as the
    last does not matter here. If it also quotes the message that it counted last, it may be arbitrarily late.
    """
    true = possible_totals(summary, before=before)
    for total in filter(summary.states, true):
        late = summary.messages > before + total
        if not late or _may_be_made_after(before + total, summary, before=before):
            return total
    earlier = {*range(SUMMARY_EVERY, true.start, SUMMARY_EVERY), *range(max(1, true.start - SUMMARY_EVERY), true.start)}
    held_back = filter(summary.states, sorted(earlier))
    return next((total for total in held_back if _is_made_after(before + total, summary, before=before)), 0)


def may_lack_lost_messages(summary: Summary, *, starts: tuple[int, ...] = (0,)) -> bool:
    """Whether a summary states one message fewer, or two, which a node that keeps one may have lost on this machine.

    `starts`: how many messages had come when the node may have begun to count.
    """
    fewer = {summary.messages - start - lost for start in starts for lost in (1, 2)}
    hurried = any(summary.trial.was_hurried(messages) for messages in range(1, summary.messages + 1))
    return hurried and any(total > 0 and summary.states(total) for total in fewer)


def total_as_rate(summary: Summary) -> Number | None:
    """The number that states the true total, if its unit says that it is a rate; None if another one states it, too."""
    stating = [number for number in summary.numbers if true_total(summary) in number.values]
    return stating[0] if stating and all(number.per_second for number in stating) else None


def swapped(summary: Summary) -> Fault:
    """The total is given where the rate should be, and so probably the rate where the total should be."""
    number = total_as_rate(summary)
    assert number is not None
    return {"fault": "count-and-rate-swapped", "number": number.text}


def find_wrong_count(summary: Summary) -> Fault:
    """Why a summary does not state the true total, by what it states."""
    trial, sent = summary.trial, summary.messages
    last, missed = trial.sent[sent - 1], sum(trial.missed(sent - 1))
    if missed and summary.states(sent + missed):
        return {"fault": "missed-messages-counted", "stated": sent + missed, "missed": missed}
    if (trial.before_break or trial.sent[0].number > 1) and any(map(summary.states, (last.number, last.number + 1))):
        return {"fault": "number-taken-for-the-count", "content": last.content}
    near = next((sent + by for by in (1, -1) if summary.states(sent + by)), None)
    if near is not None:
        return {"fault": "off-by-one", "stated": near, "sent": sent}
    numbers = ", ".join(number.text for number in summary.numbers)
    says = f"none of its numbers ({numbers}) is {sent}" if numbers else "there is no number in it"
    return {"fault": "wrong-count", "what": says}


def in_words(totals: range) -> str:
    """The totals that would be true: "30", "30 or 31", "50 to 59"."""
    if len(totals) < 3:
        return " or ".join(map(str, totals))
    return f"{totals[0]} to {totals[-1]}"


def _may_be_made_after(messages: int, summary: Summary, *, before: int) -> bool:
    """Whether its quotations are consistent with a summary that was made after this many messages."""
    newer = {message.number for message in summary.trial.sent[messages : summary.messages_at_end]}
    later = newer.intersection(quoted_without_first(summary, before=before))
    return not later or _is_made_after(messages, summary, before=before)


def _is_made_after(messages: int, summary: Summary, *, before: int) -> bool:
    """Whether the summary quotes the last of this many messages, and none that came later.

    A new publisher repeats some numbers; one that had come before does not count as later.
    """
    numbers = [message.number for message in summary.trial.sent]
    quoted = quoted_without_first(summary, before=before)
    newer = {*numbers[messages : summary.messages_at_end]}.difference(numbers[:messages])
    return numbers[messages - 1] in quoted and not newer.intersection(quoted)


def quoted_without_first(summary: Summary, *, before: int) -> list[int]:
    """The numbers that the summary quotes, without one quotation of a first message."""
    sent, quoted = summary.trial.sent, list(summary.quoted)
    for first in {sent[0].number, sent[before].number}.intersection(quoted):
        quoted.remove(first)
    return quoted
