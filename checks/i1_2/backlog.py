"""I1.2: messages that are sent, but never reach the node's callback, or reach it late."""

from __future__ import annotations

from dataclasses import dataclass

from checks.i1_2.facts import EVERY, FAST_ENOUGH_HZ, FAST_HZ, Trial
from checks.i1_2.summaries import Summary, find_summaries, group_lines

TOLERATED = 4
"""Even a queue of one, with a node that takes in each message at once, loses no more than this many by chance."""

BEHIND_S = 0.2
"""What is logged this long after the next message has come does not follow from the one before that."""


@dataclass(frozen=True, slots=True)
class LostMessages:
    """A summary that leaves messages out. `counted`: how many messages there were up to the last that it quotes.

    `excused`: the machine kept the node, or us, from running for so long that it may have lost as many.
    """

    summary: Summary
    counted: int
    excused: bool


def fast_enough(fast: Trial) -> bool:
    """Whether the messages came so fast that one that takes in ten a second has lost some."""
    return len(fast.sent) < 2 or (len(fast.sent) - 1) / (fast.sent[-1].at - fast.sent[0].at) >= FAST_ENOUGH_HZ


def find_lost(fast: Trial, steady: Trial) -> LostMessages | None:
    """Whether messages were lost when they came fast; the worst of its summaries.

    A summary may come as late as it likes: up to the message that it quotes as the last, it must have counted them all.
    What is a summary is known from the `steady` stretch. The number of the lost ones is the least that it may be.
    """
    kinds = {line.kind for summary in find_summaries(steady) for line in summary.lines if line.tells}
    order = {each.number: index for index, each in enumerate(fast.sent, start=1)}
    worst: tuple[int, LostMessages] | None = None
    for summary in group_lines([line for line in fast.lines if line.kind in kinds], fast):
        until = max((order[number] for number in summary.quoted if number in order), default=0)
        if until < 2 or not summary.numbers or any(map(summary.states, range(until - TOLERATED, until + 2))):
            continue
        stated = [value for number in summary.numbers for value in number.values if 0 < value < until]
        missing = min((until - int(value) for value in stated), default=until)
        allowed = TOLERATED + FAST_HZ * (fast.cpu_wait_s + max(fast.most_late_s, 0.0))
        if worst is None or missing > worst[0]:
            worst = missing, LostMessages(summary, until, missing <= allowed)
    return worst[1] if worst else None


def count_summarised(fast: Trial, steady: Trial) -> int:
    """How many messages there were up to the last one that a summary quotes, when they came fast.

    It may come late, and leave others out: anyone who looks once a second whether ten more have come sums up at last.
    """
    kinds = {line.kind for summary in find_summaries(steady) for line in summary.lines if line.tells}
    others = {line.kind for line in steady.lines} - kinds  # what is logged with each message
    order = {each.number: index for index, each in enumerate(fast.sent, start=1)}
    summaries = group_lines([line for line in fast.lines if line.kind not in others], fast)
    quoted = (number for summary in summaries for number in summary.quoted)
    return max((order[number] for number in quoted if number in order), default=0)


def missing_summary(fast: Trial, steady: Trial) -> bool:
    """Whether the last ten messages but those that may be lost have no summary."""
    return count_summarised(fast, steady) < (len(fast.sent) - TOLERATED) // EVERY * EVERY


def messages_behind(trial: Trial) -> int:
    """How many messages had come since the newest one that a log message quotes, at worst; 0 where it keeps up.

    One newer message may be on its way, and more where the machine kept the node from running.
    """
    order = {each.number: index for index, each in enumerate(trial.sent, start=1)}
    worst = 0
    for said in group_lines(trial.lines, trial):
        newest = max((order[number] for number in said.quoted if number in order), default=0)
        if 1 < newest < said.messages and said.at - trial.sent[newest].at > BEHIND_S + trial.allowance_s:
            worst = max(worst, said.messages - newest)
    return worst
