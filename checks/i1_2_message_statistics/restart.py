"""I1.2: the verdict on `restart`: a publisher is replaced by a new one that starts over."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from checks.i1_2_message_statistics.count import (
    Fault,
    counts_truly,
    fails,
    may_lack_lost_messages,
    quoted_without_first,
    true_total,
    unless_messages_are_lost,
)
from checks.i1_2_message_statistics.jump_reports import new_lines
from checks.i1_2_message_statistics.logged_summaries import NO_SUMMARY, Summary, find_summaries
from checks.i1_2_message_statistics.summary import EVERY_MESSAGE, judge_slow_summary, too_many
from checks.i1_2_message_statistics.trial import OURS, SUMMARY_EVERY, Trial
from tutor.judge.symptom import Symptom
from tutor.judge.verdict import Verdict, failed, passed, skipped, undecided
from tutor.judge.wording import output_tail

EXPECTED = "the publisher goes away, a new one starts over at 0: the node lives on and keeps counting"


@unless_messages_are_lost
def judge_restart(steady: Trial, jump: Trial, restart: Trial, fast: Trial) -> Verdict:
    """Judge `restart`."""
    if not find_summaries(steady):
        return skipped(NO_SUMMARY)
    words = output_tail(restart.trace)
    sent, before = len(restart.sent), restart.before_break
    if restart.trace.exit is not None:
        observed = f"the node ended after {sent} of our messages"
        return failed(EXPECTED, observed, restart.ended("another publisher"), words)
    if not restart.jumps:
        deaf = restart.seen(Symptom.NOTHING_RECEIVED, answers=restart.spins, ours=OURS)
        return failed(EXPECTED, f"the new publisher found no subscription on {OURS.topic}", deaf, words)
    after = [summary for summary in find_summaries(restart) if summary.messages > before]
    observed = f"{before} messages from the first publisher, {sent - before} from the second"
    if not after:
        return fails(EXPECTED, f"{observed}; no summary since", restart, {"fault": "stopped-counting"})
    if not counts_truly(steady, jump):
        return skipped("not judged, because `count` did not pass")
    reports = [line.text for line in new_lines(restart, since=restart.first_publisher_left_at, usual=(steady, jump))]
    for summary in after:
        restarted = true_total(summary, before=before)
        if true_total(summary) or (restarted and reports):
            continue
        if not restarted and may_lack_lost_messages(summary, starts=(0, before)):
            return undecided("to tell whether the node lost messages")
        return fails(EXPECTED, f"{observed}; {summary}", restart, _see_wrong_count(summary, restarted))
    if judge_slow_summary(steady, jump).passed and (fault := _find_fault(after, restart, steady)):
        return fails(EXPECTED, observed, restart, fault)
    return passed(EXPECTED, observed, [*map(str, find_summaries(restart)), *reports[:2]])


def _see_wrong_count(summary: Summary, restarted: int) -> Fault:
    messages, before = summary.messages, summary.trial.before_break
    if restarted:
        return {"fault": "starts-over-silently", "restarted": restarted, "messages": messages}
    return {"fault": "wrong-count-after-a-restart", "messages": messages, "new": messages - before}


def _find_fault(after: Sequence[Summary], restart: Trial, steady: Trial) -> Fault | None:
    """Find faults in the summaries since the restart that do not depend on where the node begins to count."""
    before = restart.before_break
    new = len(restart.sent) - before
    times = max(len(after), _count_summaries(after, find_summaries(steady)))
    if times >= 0.7 * new:
        return too_many(times, new, EVERY_MESSAGE)
    own = [summary for summary in after if summary.messages > before + 1]  # may not quote only the old publisher
    if own and not any(map(_quotes_new_publisher, own)):
        return {"fault": "last-message-missing", "what": "no summary quotes what the new publisher has sent last"}
    return None


def _count_summaries(found: Sequence[Summary], usual: Sequence[Summary]) -> int:
    """The number of summaries, by the number of lines that a usual one has.

    A node that waited for the CPU may log several summaries at once, so that they look like one.
    """
    lines, usual_lines = (Counter(line.kind for summary in of for line in summary.lines) for of in (found, usual))
    return min((lines[kind] * len(usual) // usual_lines[kind] for kind in usual_lines if kind in lines), default=0)


def _quotes_new_publisher(summary: Summary) -> bool:
    """Whether the summary quotes a recent message of the new publisher, apart from a first message."""
    sent, before = summary.trial.sent, summary.trial.before_break
    quoted = quoted_without_first(summary, before=before)
    recent = sent[max(before, summary.messages - SUMMARY_EVERY) : summary.messages_at_end]
    return any(message.number in quoted for message in recent)
