"""I1.2: messages that the node handles late, never, or twice."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import wraps
from typing import Any

from checks.i1_2_message_statistics.logged_summaries import Summary, find_summaries, group_lines, summary_kinds
from checks.i1_2_message_statistics.plans import FAST_HZ, FAST_MESSAGES
from checks.i1_2_message_statistics.trial import CHATTER, STALL_S, SUMMARY_EVERY, Trial
from tutor.judge.symptom import Symptom
from tutor.judge.verdict import Failure, Verdict
from tutor.ros_model import TopicEndpoint

FAST_ENOUGH_HZ = 20.0
"""A machine on which our average rate stays below this is too busy."""

TOLERATED_LOSSES = 4
"""Number of messages that may be lost by chance: a prompt node loses no more, even with a queue depth of 1."""

BEHIND_S = 0.2
"""A log message this long after the next message was sent is not in time for the one before."""

MAX_RENEWALS = 2
"""New subscriptions, while messages come, that a node may have reasons for."""


def of_what_comes[V: Verdict | None](judge: Callable[..., V]) -> Callable[..., V]:
    """Decorate a judge: what its failures have seen also tells what the node does with the messages that come."""

    @wraps(judge)
    def judged(*trials: Trial) -> V:
        verdict = judge(*trials)
        if not isinstance(verdict, Failure) or any(trial.trace.exit is not None for trial in trials):
            return verdict
        seen = verdict.seen
        if seen is None or seen.symptom not in (Symptom.WRONG_LOG, Symptom.NOT_LOGGED):
            return verdict
        return replace(verdict, seen=replace(seen, about={**seen.about, **_find_facts(trials)}))

    return judged


def renews_subscription(trial: Trial) -> bool:
    """Whether the node gives up its subscription and makes a new one again and again, as for each message."""
    return trial.new_subscriptions > MAX_RENEWALS


def was_sent_fast_enough(fast: Trial) -> bool:
    """Whether the messages were sent fast enough that a node that handles ten per second loses some."""
    return len(fast.sent) < 2 or (len(fast.sent) - 1) / (fast.sent[-1].at - fast.sent[0].at) >= FAST_ENOUGH_HZ


@dataclass(frozen=True, slots=True)
class LostMessages:
    """A summary whose count lacks messages. `counted`: the true count, up to the last message that it quotes.

    `slowed`: the node or our process waited for a CPU long enough to explain the loss.
    """

    summary: Summary
    counted: int
    slowed: bool


def find_lost(fast: Trial, steady: Trial) -> LostMessages | None:
    """Find the summary that lacks most messages in the `fast` trial; None if none were lost.

    A summary may be arbitrarily late, but must count all messages up to the last one that it quotes. Summaries are
    recognised by their wording in the `steady` trial. The number of lost messages is a lower bound.
    """
    kinds = summary_kinds(steady)
    allowed = TOLERATED_LOSSES + FAST_HZ * (fast.cpu_wait_s + max(fast.max_delay_s, 0.0))
    worst: tuple[int, LostMessages] | None = None
    for summary in group_lines((line for line in fast.lines if line.kind in kinds), fast):
        until = newest_quoted(summary)
        if until < 2 or not summary.numbers or any(map(summary.states, range(until - TOLERATED_LOSSES, until + 2))):
            continue
        stated = [value for number in summary.numbers for value in number.values if 0 < value < until]
        missing = min((until - int(value) for value in stated), default=until)
        if worst is None or missing > worst[0]:
            worst = missing, LostMessages(summary, until, missing <= allowed)
    return worst[1] if worst else None


def newest_quoted(summary: Summary) -> int:
    """How many messages had been sent up to the newest one that is quoted; 0 if none is."""
    order = summary.trial.order
    return max((order[number] for number in summary.quoted if number in order), default=0)


def count_summarised(fast: Trial, steady: Trial) -> int:
    """How many messages had been sent up to the last one that any summary quotes, in the `fast` trial.

    Summaries may be late, or left out: a node that checks once a second for ten more messages catches up at the end.
    """
    per_message_kinds = {line.kind for line in steady.lines} - summary_kinds(steady)
    summaries = group_lines((line for line in fast.lines if line.kind not in per_message_kinds), fast)
    return max(map(newest_quoted, summaries), default=0)


def is_summary_missing(fast: Trial, steady: Trial) -> bool:
    """Whether no summary covers the last ten messages, apart from those that may be lost by chance."""
    return count_summarised(fast, steady) < (len(fast.sent) - TOLERATED_LOSSES) // SUMMARY_EVERY * SUMMARY_EVERY


def messages_behind(trial: Trial) -> int:
    """By how many messages the node's log lags behind what was sent, at worst; 0 if the node keeps up.

    One newer message may still be in flight, and more if the node waited for the CPU.
    """
    worst = 0
    for group in group_lines(trial.lines, trial):
        newest = newest_quoted(group)
        if 1 < newest < group.messages and group.at - trial.sent[newest].at > BEHIND_S + trial.allowance_s:
            worst = max(worst, group.messages - newest)
    return worst


def fast_summaries(fast: Trial) -> Sequence[Summary]:
    """The summaries of a fast stretch; none if some may be missing, late or torn because the messages came fast.

    Nor if there are two subscriptions that may log each message twice: the slow messages show the cause of that better.
    Nor if the node makes new ones all the time: what it loses is luck.
    """
    summaries = find_summaries(fast)
    whole = (
        len(fast.sent) >= FAST_MESSAGES
        and was_sent_fast_enough(fast)
        and len(summaries) >= len(fast.sent) // SUMMARY_EVERY
    )
    prompt = fast.spins and fast.allowance_s < STALL_S and not messages_behind(fast)
    alone = sum(subscription.topic == CHATTER.name for subscription in fast.trace.graph.subscriptions) == 1
    return summaries if whole and prompt and alone and not renews_subscription(fast) else ()


def _find_facts(trials: Sequence[Trial]) -> dict[str, Any]:
    """The facts that are so: `late`, in words, and whether it is `surely_late`, whatever it counts; `own_publisher`.

    `subscriptions`, if each message counts twice; `renewals` of its subscription.
    """
    facts: dict[str, Any] = {"topic": CHATTER.name, "type": CHATTER.type}
    for trial in trials:
        subscriptions = _on_topic(trial.trace.graph.subscriptions)
        if len(subscriptions) > 1 and _has_doubled_count(trial):
            facts["subscriptions"] = len(subscriptions)
        publishers = _on_topic(trial.trace.graph.publishers)
        if publishers and any(line.numbers for line in trial.lines):
            facts["own_publisher"] = publishers[0].node
        if renews_subscription(trial):
            facts["renewals"] = trial.new_subscriptions
        if (late := _find_delay(trial, trials)) and "late" not in facts:
            facts["late"] = late
        # A wrong count looks like lost messages, and a node that says nothing may well be prompt.
        facts["surely_late"] = facts.get("surely_late", False) or messages_behind(trial) > 0
    return facts


def _on_topic(endpoints: Sequence[TopicEndpoint]) -> list[TopicEndpoint]:
    return [endpoint for endpoint in endpoints if (endpoint.topic, endpoint.type) == (CHATTER.name, CHATTER.type)]


def _find_delay(trial: Trial, trials: Sequence[Trial]) -> str:
    """How the node handles messages late or not at all, in words; "" if it keeps up."""
    if behind := messages_behind(trial):
        return f"a message is handled when {behind} newer ones have come, or never"
    if not trial.jumps and any(find_lost(trial, other) for other in trials):
        return "some messages never reach the callback"
    if trial.sent and trial.spins and not trial.lines:
        return "the node is not done with its messages in time"
    return ""


def _has_doubled_count(trial: Trial) -> bool:
    """Whether a number in the log is always twice the number of messages sent."""
    for kind in {line.kind for line in trial.lines}:
        lines = [line for line in trial.lines if line.kind == kind and line.numbers]
        for place in range(min((len(line.numbers) for line in lines), default=0)):
            if len(lines) > 1 and all(
                2 * line.messages - 1 <= line.numbers[place].value <= 2 * line.messages for line in lines
            ):
                return True
    return False
