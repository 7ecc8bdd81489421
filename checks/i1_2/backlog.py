"""I1.2: messages that reach the node's callback late or never."""

from __future__ import annotations

from dataclasses import dataclass

from checks.i1_2.facts import FAST_ENOUGH_HZ, FAST_HZ, SUMMARY_EVERY, Trial
from checks.i1_2.summaries import Summary, find_summaries, group_lines

TOLERATED_LOSSES = 4
"""Number of messages that may be lost by chance: a prompt node loses no more, even with a queue depth of 1."""

BEHIND_S = 0.2
"""A log message this long after the next message was sent is not in time for the one before."""


@dataclass(frozen=True, slots=True)
class LostMessages:
    """A summary whose count lacks messages. `counted`: the true count, up to the last message that it quotes.

    `excused`: the node or our process waited for the CPU long enough to explain the loss.
    """

    summary: Summary
    counted: int
    excused: bool


def was_sent_fast_enough(fast: Trial) -> bool:
    """Whether the messages were sent fast enough that a node that handles ten per second loses some."""
    return len(fast.sent) < 2 or (len(fast.sent) - 1) / (fast.sent[-1].at - fast.sent[0].at) >= FAST_ENOUGH_HZ


def find_lost(fast: Trial, steady: Trial) -> LostMessages | None:
    """Find the summary that lacks most messages in the `fast` trial; None if none were lost.

    A summary may be arbitrarily late, but must count all messages up to the last one that it quotes. Summaries are
    recognised by their wording in the `steady` trial. The number of lost messages is a lower bound.
    """
    summary_kinds = {line.kind for summary in find_summaries(steady) for line in summary.lines if line.tells}
    order = {each.number: index for index, each in enumerate(fast.sent, start=1)}
    worst: tuple[int, LostMessages] | None = None
    for summary in group_lines([line for line in fast.lines if line.kind in summary_kinds], fast):
        until = max((order[number] for number in summary.quoted if number in order), default=0)
        if until < 2 or not summary.numbers or any(map(summary.states, range(until - TOLERATED_LOSSES, until + 2))):
            continue
        stated = [value for number in summary.numbers for value in number.values if 0 < value < until]
        missing = min((until - int(value) for value in stated), default=until)
        allowed = TOLERATED_LOSSES + FAST_HZ * (fast.cpu_wait_s + max(fast.max_delay_s, 0.0))
        if worst is None or missing > worst[0]:
            worst = missing, LostMessages(summary, until, missing <= allowed)
    return worst[1] if worst else None


def count_summarised(fast: Trial, steady: Trial) -> int:
    """How many messages had been sent up to the last one that any summary quotes, in the `fast` trial.

    Summaries may be late, or left out: a node that checks once a second for ten more messages catches up at the end.
    """
    summary_kinds = {line.kind for summary in find_summaries(steady) for line in summary.lines if line.tells}
    per_message_kinds = {line.kind for line in steady.lines} - summary_kinds  # those logged for every message
    order = {each.number: index for index, each in enumerate(fast.sent, start=1)}
    summaries = group_lines([line for line in fast.lines if line.kind not in per_message_kinds], fast)
    quoted = (number for summary in summaries for number in summary.quoted)
    return max((order[number] for number in quoted if number in order), default=0)


def is_summary_missing(fast: Trial, steady: Trial) -> bool:
    """Whether no summary covers the last ten messages, apart from those that may be lost by chance."""
    return count_summarised(fast, steady) < (len(fast.sent) - TOLERATED_LOSSES) // SUMMARY_EVERY * SUMMARY_EVERY


def messages_behind(trial: Trial) -> int:
    """By how many messages the node's log lags behind what was sent, at worst; 0 if the node keeps up.

    One newer message may still be in flight, and more if the node waited for the CPU.
    """
    order = {each.number: index for index, each in enumerate(trial.sent, start=1)}
    worst = 0
    for group in group_lines(trial.lines, trial):
        newest = max((order[number] for number in group.quoted if number in order), default=0)
        if 1 < newest < group.messages and group.at - trial.sent[newest].at > BEHIND_S + trial.allowance_s:
            worst = max(worst, group.messages - newest)
    return worst
