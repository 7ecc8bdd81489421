"""I1.2: failures that the fast stretch alone shows, before the slow messages have all been sent."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from checks.i1_2 import backlog, losses
from checks.i1_2.causes import (
    EVERY_MESSAGE,
    diagnose_count,
    diagnose_incomplete_summary,
    diagnose_interval,
    diagnose_no_summary,
    last_logs,
)
from checks.i1_2.facts import FAST_MESSAGES, STALL_S, SUMMARY_EVERY, TOPIC, Trial
from checks.i1_2.judges import EXPECTED_COUNT, EXPECTED_SUMMARY
from checks.i1_2.summaries import Summary, find_summaries, is_complete, possible_totals
from tutor.judge.verdict import Verdict, failed


def judge_fast_count(fast: Trial) -> Verdict | None:
    """Judge `count` by the fast stretch alone: fail if no summary states anything like the true total.

    A total that a lagging node may state, or one whose summary waits for a timer, is not held against it.
    """
    summaries = _fast_summaries(fast)
    if not summaries or not all(is_complete(summary, fast) for summary in summaries):
        return None
    if any(
        summary.states(total)
        for summary in summaries
        for total in range(SUMMARY_EVERY, summary.messages_at_end + 1, SUMMARY_EVERY)
    ):
        return None
    if any(any(map(summary.states, possible_totals(summary, fast))) for summary in summaries):
        return None
    last = summaries[-1]
    return failed(
        f"{EXPECTED_COUNT}: {' or '.join(map(str, possible_totals(last, fast)))}",
        f"the summary that came after {last.messages} messages does not say so",
        diagnose_count(last, fast),
        [str(summary) for summary in summaries],
    )


def judge_fast_summary(fast: Trial) -> Verdict | None:
    """Judge `summary` by the fast stretch alone.

    Fail a node that responds but logs nothing about any message, one that logs far too many summaries, and one whose
    summaries all lack the same thing.
    """
    if not fast.lines:
        silent = fast.spins and len(fast.sent) >= FAST_MESSAGES and backlog.was_sent_fast_enough(fast)
        observed = f"none, after {len(fast.sent)} messages"
        return failed(EXPECTED_SUMMARY, observed, diagnose_no_summary(fast), last_logs(fast)) if silent else None
    summaries = _fast_summaries(fast)
    if not summaries:
        return None
    evidence = [str(summary) for summary in summaries[:8]]
    whole = all(is_complete(summary, fast) for summary in summaries)
    if whole and len(summaries) >= 1.5 * len(fast.sent) / SUMMARY_EVERY:
        when = ", ".join(str(summary.messages) for summary in summaries[:12])
        cause = diagnose_interval(summaries, fast, len(fast.sent))
        observed = f"summaries after {when} messages, of {len(fast.sent)}"
        apart = {after.messages - before.messages for before, after in pairwise(summaries)}
        # At different distances, some may be several that look like one because the messages came fast.
        is_clear = cause is not None and (cause.name == EVERY_MESSAGE or len(apart) == 1)
        return failed(EXPECTED_SUMMARY, observed, cause, evidence) if cause and is_clear else None
    if any(summary.messages % SUMMARY_EVERY > 1 for summary in summaries):  # perhaps timed by a wrong count
        return None
    missing = [diagnose_incomplete_summary(summary, fast) for summary in summaries[1:]]  # the first may be complete
    cause = missing[-1]
    if cause is None or {each and each.name for each in missing} != {cause.name}:
        return None
    return failed(EXPECTED_SUMMARY, f"it is incomplete {summaries[-1]}", cause, evidence)


def _fast_summaries(fast: Trial) -> Sequence[Summary]:
    """The summaries of a fast stretch; none if some may be missing, late or torn because the messages came fast.

    Nor if there are two subscriptions that may log each message twice: the slow messages show the cause of that better.
    Nor if the node makes new ones all the time: what it loses is luck.
    """
    summaries = find_summaries(fast)
    whole = (
        len(fast.sent) >= FAST_MESSAGES
        and backlog.was_sent_fast_enough(fast)
        and len(summaries) >= len(fast.sent) // SUMMARY_EVERY
    )
    prompt = fast.spins and fast.allowance_s < STALL_S and not backlog.messages_behind(fast)
    alone = sum(each.topic == TOPIC for each in fast.trace.graph.subscriptions) == 1
    steady = not losses.renews_subscription(fast)
    return summaries if whole and prompt and alone and steady else ()
