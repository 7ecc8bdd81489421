"""I1.2: the verdict on a publisher that is replaced by a new one that starts over."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from checks.i1_2 import losses
from checks.i1_2.facts import OURS, SUMMARY_EVERY, TOPIC, TYPE, Trial
from checks.i1_2.faults import EVERY_MESSAGE, Fault, ended, too_many, wrong_log
from checks.i1_2.judges import NO_SUMMARY, judge_slow_summary
from checks.i1_2.reports import new_lines
from checks.i1_2.summaries import Summary, find_summaries
from checks.i1_2.totals import counts_truly, may_lack_lost_messages, true_total
from tutor.judge.symptom import Symptom
from tutor.judge.verdict import Verdict, failed, passed, skipped, undecided
from tutor.judge.wording import output_tail


def judge_restart(restart: Trial, steady: Trial, jump: Trial, fast: Trial) -> Verdict:
    """Judge `restart`."""
    if find_summaries(steady) and losses.is_certain(steady, fast):
        return skipped(losses.SEE_COUNT)
    return judge_new_publisher(restart, steady, jump)


def judge_new_publisher(restart: Trial, steady: Trial, jump: Trial) -> Verdict:
    """Judge `restart` of a node that loses no messages."""
    expected = "the publisher goes away, a new one starts over at 0: the node lives on and keeps counting"
    if not find_summaries(steady):
        return skipped(NO_SUMMARY)
    words = output_tail(restart.trace)
    sent, before = len(restart.sent), restart.before_break
    if restart.trace.exit is not None:
        return failed(
            expected, f"the node ended after {sent} of our messages", ended(restart, "another publisher"), words
        )
    if not before or sent <= before:
        return failed(
            expected,
            f"the new publisher found no subscription on {OURS.topic}",
            Symptom.NOTHING_RECEIVED.seen(restart.trace, answers=restart.spins, topic=TOPIC, type=TYPE, ours=OURS),
            words,
        )
    after = [summary for summary in find_summaries(restart) if summary.messages > before]
    evidence = [str(summary) for summary in find_summaries(restart)]
    observed = f"{before} messages from the first publisher, {sent - before} from the second"
    if not after:
        return failed(
            expected,
            f"{observed}; no summary since",
            wrong_log(restart.trace, {"fault": "stopped-counting"}),
            evidence,
        )
    if not counts_truly(steady, jump):
        return skipped("not judged, because `count` did not pass")
    reports = [line.text for line in new_lines(restart, since=restart.first_publisher_left_at, usual=(steady, jump))]
    for summary in after:
        if true_total(summary, restart):
            continue
        restarted = true_total(summary, restart, before=before)
        if restarted and reports:
            continue
        if not restarted and may_lack_lost_messages(summary, restart, starts=(0, before)):
            return undecided("to tell whether the node lost messages")
        fault: Fault = (
            {"fault": "starts-over-silently", "restarted": restarted, "messages": summary.messages}
            if restarted
            else {
                "fault": "wrong-count-after-a-restart",
                "messages": summary.messages,
                "new": summary.messages - before,
            }
        )
        return failed(expected, f"{observed}; {summary}", wrong_log(restart.trace, fault), evidence)
    if judge_slow_summary(steady, jump).passed and (changed := _find_fault(after, restart, steady)):
        return failed(expected, observed, wrong_log(restart.trace, changed), evidence)
    return passed(expected, observed, [*evidence, *reports[:2]])


def _find_fault(after: Sequence[Summary], restart: Trial, steady: Trial) -> Fault | None:
    """Find faults in the summaries since the restart that do not depend on where the node begins to count."""
    before = restart.before_break
    new = len(restart.sent) - before
    times = max(len(after), _count_summaries(after, find_summaries(steady)))
    if times >= 0.7 * new:
        return too_many(times, new) | {"fault": EVERY_MESSAGE}
    own = [summary for summary in after if summary.messages > before + 1]  # may not quote only the old publisher
    if own and not any(_quotes_new_publisher(summary, restart) for summary in own):
        return {"fault": "last-message-missing", "what": "no summary quotes what the new publisher has sent last"}
    return None


def _count_summaries(found: Sequence[Summary], usual: Sequence[Summary]) -> int:
    """The number of summaries, by the number of lines that a usual one has.

    A node that waited for the CPU may log several summaries at once, so that they look like one.
    """
    lines, usual_values = (Counter(line.kind for each in of for line in each.lines) for of in (found, usual))
    return min((lines[kind] * len(usual) // usual_values[kind] for kind in usual_values if kind in lines), default=0)


def _quotes_new_publisher(summary: Summary, restart: Trial) -> bool:
    """Whether the summary quotes a recent message of the new publisher, apart from a first message."""
    quoted = list(summary.quoted)
    for first in {restart.sent[0].number, restart.sent[restart.before_break].number}.intersection(quoted):
        quoted.remove(first)
    recent = restart.sent[max(restart.before_break, summary.messages - SUMMARY_EVERY) : summary.messages_at_end]
    return any(each.number in quoted for each in recent)
