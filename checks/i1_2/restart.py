"""I1.2: the verdict on a publisher that is replaced by a new one that starts over."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from checks.i1_2 import losses, steps
from checks.i1_2.causes import diagnose_end
from checks.i1_2.facts import OURS, SUMMARY_EVERY, Trial
from checks.i1_2.judges import NO_SUMMARY, judge_slow_summary
from checks.i1_2.reports import new_lines
from checks.i1_2.summaries import Summary, find_summaries
from checks.i1_2.totals import counts_truly, may_lack_lost_messages, true_total
from tutor.judge import causes
from tutor.judge.verdict import Cause, Verdict, failed, passed, skipped, undecided


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
    words = causes.output_tail(restart.trace)
    sent, before = len(restart.sent), restart.before_break
    if restart.trace.exit is not None:
        return failed(
            expected, f"the node ended after {sent} of our messages", diagnose_end(restart, "another publisher"), words
        )
    if not before or sent <= before:
        return failed(
            expected,
            f"the new publisher found no subscription on {OURS.topic}",
            steps.keep_node_up(
                restart.trace, causes.diagnose_nothing_received(restart.trace, OURS, answers=restart.spins)
            ),
            words,
        )
    after = [summary for summary in find_summaries(restart) if summary.messages > before]
    evidence = [str(summary) for summary in find_summaries(restart)]
    observed = f"{before} messages from the first publisher, {sent - before} from the second"
    if not after:
        return failed(
            expected,
            f"{observed}; no summary since",
            Cause(
                "stopped counting",
                "the node is there, but sums up nothing that the new publisher sends",
                steps.go_on_after_restart(restart.trace)
                or "do nothing special when N falls: keep counting, or reset everything and say so",
            ),
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
        cause = (
            Cause(
                "starts over silently",
                f"it says {restarted} after {summary.messages} messages, and no log message says that it started over",
                steps.announce_restart(restart.trace)
                or "go on with the total, or log that the publisher was restarted and that you count from zero",
            )
            if restarted
            else Cause(
                "wrong count after a restart",
                f"{summary.messages} messages in all, {summary.messages - before} of them from the new publisher: "
                "it states neither",
                steps.go_on_after_restart(restart.trace)
                or "do not compute the total from N; keep counting, or reset everything and say so",
            )
        )
        return failed(expected, f"{observed}; {summary}", cause, evidence)
    if judge_slow_summary(steady, jump).passed and (changed := _diagnose_summaries(after, restart, steady)):
        return failed(expected, observed, changed, evidence)
    return passed(expected, observed, [*evidence, *reports[:2]])


def _diagnose_summaries(after: Sequence[Summary], restart: Trial, steady: Trial) -> Cause | None:
    """Find faults in the summaries since the restart that do not depend on where the node begins to count."""
    before = restart.before_break
    new = len(restart.sent) - before
    times = max(len(after), _count_summaries(after, find_summaries(steady)))
    if times >= 0.7 * new:
        return Cause(
            "summary for every message",
            f"{times} summaries for {new} messages of the new publisher",
            steps.go_on_after_restart(restart.trace)
            or "once N has fallen, go on as before: a summary for every ten messages",
        )
    own = [summary for summary in after if summary.messages > before + 1]  # may not quote only the old publisher
    if own and not any(_quotes_new_publisher(summary, restart) for summary in own):
        return Cause(
            "last message missing",
            "no summary quotes what the new publisher has sent last",
            steps.go_on_after_restart(restart.trace) or "self.last_message = msg.data for each message, whatever its N",
        )
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
