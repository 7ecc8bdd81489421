"""I1.2: the verdicts on `count`, `rate`, `summary` and `shutdown`."""

from __future__ import annotations

from collections.abc import Sequence

from checks.i1_2 import backlog, kept_rate, losses, rates
from checks.i1_2.facts import FAST_HZ, OURS, RESTARTED_HZ, SUMMARY_EVERY, TOPIC, TYPE, Trial
from checks.i1_2.faults import (
    find_incomplete,
    find_wrong_count,
    find_wrong_interval,
    in_words,
    last_logs,
    swapped,
    too_many,
    wrong_log,
)
from checks.i1_2.reading import parse_log
from checks.i1_2.summaries import Summary, count_complete, find_summaries, possible_totals
from checks.i1_2.totals import counts_truly, may_lack_lost_messages, total_as_rate, true_total
from tutor.judge import ending
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import LogRecord
from tutor.judge.verdict import Verdict, failed, passed, skipped, undecided

EXPECTED_SUMMARY = f"one summary for every {SUMMARY_EVERY} messages, with the first and the last message's content"
BUSY_S = 0.5
"""If the node waited longer for a CPU, missing summaries may be the machine's fault."""

EXPECTED_COUNT = "each summary states how many messages have come"
NO_SUMMARY = "not judged, because there is no summary to read: see `summary`"


def judge_count(steady: Trial, jump: Trial, fast: Trial) -> Verdict:
    """Judge `count`."""
    renewing = next((trial for trial in (steady, fast) if losses.renews_subscription(trial)), None)
    if renewing is not None and find_summaries(steady):
        observed, evidence = losses.describe_renewals(renewing), [str(summary) for summary in find_summaries(renewing)]
        return failed(EXPECTED_COUNT, observed, losses.see_renewals(renewing), evidence[:6])
    verdict = judge_slow_count(steady, jump)
    if not verdict.passed:
        return verdict
    lost = backlog.find_lost(fast, steady)
    if lost.excused if lost else not backlog.was_sent_fast_enough(fast):
        return undecided("to send messages fast")
    if lost is None:
        return verdict
    return failed(
        f"{EXPECTED_COUNT}, at {FAST_HZ:g} a second, too",
        f"{lost.counted} messages up to the last that it quotes; {lost.summary}",
        wrong_log(fast.trace, {"fault": "cannot-keep-up", "counted": lost.counted}),
        [str(summary) for summary in find_summaries(fast)[:6]],
    )


def judge_slow_count(steady: Trial, jump: Trial) -> Verdict:
    """Judge `count` by the messages that come slowly."""
    expected = EXPECTED_COUNT
    if not find_summaries(steady):
        return skipped(NO_SUMMARY)
    seen = [(trial, summary) for trial in (steady, jump) for summary in find_summaries(trial)]
    wrong = [(trial, summary) for trial, summary in seen if not true_total(summary, trial)]
    if 0 < len(wrong) < len(seen) and all(may_lack_lost_messages(summary, trial) for trial, summary in wrong):
        return undecided("to tell whether the node lost messages")
    if wrong:
        trial, summary = wrong[-1]  # after the jump, N and the count differ most, so that the cause is clearest
        return failed(
            f"{expected}: {in_words(possible_totals(summary, trial))}",
            f"the summary that came after {summary.messages} messages does not say so",
            wrong_log(trial.trace, find_wrong_count(summary, trial)),
            [str(other) for _, other in seen],
        )
    if all(total_as_rate(summary, trial) for trial, summary in seen):
        trial, summary = seen[-1]
        return failed(
            expected,
            f"the summary that came after {summary.messages} messages does not say so",
            wrong_log(trial.trace, swapped(summary, trial)),
            [str(other) for _, other in seen],
        )
    stated = ", ".join(str(true_total(summary, trial)) for trial, summary in seen)
    return passed(expected, f"{len(seen)} summaries state {stated}", [str(summary) for _, summary in seen])


def judge_rate(steady: Trial, jump: Trial, restart: Trial, fast: Trial) -> Verdict:
    """Judge `rate`."""
    if find_summaries(steady) and losses.is_certain(steady, fast):
        return skipped(losses.SEE_COUNT)
    return judge_stated_rate(steady, jump, restart)


def judge_stated_rate(steady: Trial, jump: Trial, restart: Trial | None = None) -> Verdict:
    """Judge `rate` of a node that loses no messages. `restart`: a run in which the rate changes."""
    summaries = [summary for summary in find_summaries(steady) if summary.messages > 1]  # one message gives no rate yet
    if not summaries:
        return skipped(NO_SUMMARY)
    allowed = [rates.true_rates(summary, steady) for summary in summaries]
    low, high = min(each.low for each in allowed), max(each.high for each in allowed)
    expected = f"each summary states the messages per second: {rates.sent_hz(steady):.2f}, from {low:.1f} to {high:.1f}"
    evidence = [str(summary) for summary in summaries]
    stated = rates.find_stated_rates(summaries, allowed, jump)
    if stated is not None and all(total_as_rate(summary, steady) for summary in summaries):
        wrong = summaries[-1]
        observed = f"after {wrong.messages} messages it states {', '.join(n.text for n in wrong.numbers)}"
        return failed(expected, observed, wrong_log(steady.trace, swapped(wrong, steady)), evidence)
    if stated is None:
        wrong = next((r for r, a in zip(summaries, allowed, strict=True) if not a.among(r)), summaries[-1])
        return failed(
            expected,
            f"after {wrong.messages} messages it states {', '.join(n.text for n in wrong.numbers) or 'no number'}",
            wrong_log(steady.trace, rates.find_wrong_rate(wrong, summaries, steady)),
            evidence,
        )
    if rates.is_doubtful_rate(stated, summaries, steady):
        return undecided("to send messages at an even rate")
    if restart is not None and (kept := kept_rate.find_kept_rate(restart)) is not None:
        return failed(
            "each summary states the messages per second, also when they change",
            f"{kept.text} at first, and still {kept.text} when another talker sends {RESTARTED_HZ:g} a second",
            wrong_log(restart.trace, {"fault": "rate-never-updated", "rate": kept.text}),
            [str(summary) for summary in find_summaries(restart)],
        )
    return passed(expected, f"{', '.join(number.text for number in stated)} messages per second", evidence)


def judge_summary(steady: Trial, jump: Trial, fast: Trial) -> Verdict:
    if find_summaries(steady) and losses.is_certain(steady, fast):
        return skipped(losses.SEE_COUNT)
    verdict = judge_slow_summary(steady, jump)
    if not verdict.passed or backlog.find_lost(fast, steady) is not None:  # `count` reports lost messages
        return verdict
    if not backlog.is_summary_missing(fast, steady):
        return verdict
    if not backlog.was_sent_fast_enough(fast) or fast.allowance_s > BUSY_S:
        return undecided("to send messages fast")
    return failed(
        f"{EXPECTED_SUMMARY}, at {FAST_HZ:g} a second, too",
        f"of {len(fast.sent)} messages, none since message {backlog.count_summarised(fast, steady)}",
        Symptom.NOT_LOGGED.seen(fast.trace, topic=TOPIC, type=TYPE, fault="fewer-summaries"),
        [str(summary) for summary in find_summaries(fast)[:6]],
    )


def judge_slow_summary(steady: Trial, jump: Trial) -> Verdict:
    """Judge `summary` by the messages that come slowly."""
    expected = EXPECTED_SUMMARY
    if not find_summaries(steady):
        if (many := count_complete(steady)) > len(steady.sent) // SUMMARY_EVERY:
            text = f"{many} summaries for {len(steady.sent)} messages"
            again = wrong_log(steady.trace, too_many(many, len(steady.sent)))
            return failed(expected, text, again, last_logs(steady))
        return failed(expected, f"none, after {len(steady.sent)} messages", see_no_summary(steady), last_logs(steady))
    # A node that exits or miscounts from the jump on fails other criteria.
    survives_jump = jump.trace.exit is None and counts_truly(jump)
    for trial, messages in ((steady, len(steady.sent)), (jump, len(jump.sent) if survives_jump else jump.before_break)):
        summaries = [summary for summary in find_summaries(trial) if summary.messages <= messages]
        evidence = [str(summary) for summary in summaries[:8]]
        if (fault := find_wrong_interval(summaries, trial, messages)) is not None:
            if _counts_wrongly(summaries, trial):
                return skipped("not judged, because `count` did not pass: summaries are timed by a wrong count")
            observed = (
                f"summaries after {', '.join(str(summary.messages) for summary in summaries[:12]) or 'no'} messages"
            )
            return failed(expected, f"{observed}, of {messages}", wrong_log(trial.trace, fault), evidence)
        for summary in summaries:
            if (fault := find_incomplete(summary, trial)) is not None:
                return failed(expected, f"it is incomplete {summary}", wrong_log(trial.trace, fault), evidence)
    late = find_summaries(jump)
    if not survives_jump and jump.trace.exit is None and len(late) > len(jump.sent) // SUMMARY_EVERY + 1:
        return failed(
            expected,
            f"{len(late)} summaries for {len(jump.sent)} messages",
            wrong_log(jump.trace, too_many(len(late), len(jump.sent))),
            [str(summary) for summary in late[-6:]],
        )
    complete = find_summaries(steady)
    return passed(
        expected,
        f"{len(complete)} for {len(steady.sent)} messages, with both contents",
        [str(summary) for summary in complete],
    )


def see_no_summary(trial: Trial) -> Observation:
    """The node logs no summary, or is not there to log one."""
    about = {"topic": TOPIC, "type": TYPE}
    idle = not trial.spins and not trial.lines
    if trial.trace.exit is not None or not trial.sent or idle:
        return Symptom.NOTHING_RECEIVED.seen(trial.trace, stuck=trial.stuck, answers=trial.spins, ours=OURS, **about)
    return Symptom.NOT_LOGGED.seen(
        trial.trace,
        stuck=trial.stuck,
        answers=trial.spins,
        fault="no-summary",
        what="what the node has to say",
        recognise=lambda text: bool(parse_log(LogRecord(20, "", text, 0.0, 0.0), 1).quoted),
        at_end=trial.ending.output if trial.ending else (),
        logged=bool(trial.lines),
        only_debug=not trial.lines,
        **about,
    )


def _counts_wrongly(summaries: Sequence[Summary], trial: Trial) -> bool:
    """Whether each summary is timed by the node's own count, and that count is wrong.

    A single count may be right by chance: if a node counts one too many, its summary after 9 messages may come late,
    after the 10th.
    """
    by_its_count = all(summary.states(SUMMARY_EVERY * number) for number, summary in enumerate(summaries, start=1))
    return by_its_count and any(not true_total(summary, trial) for summary in summaries)


def judge_shutdown(fast: Trial) -> Verdict:
    return ending.judge_ending(fast.trace, fast.ending, shown_by="summary")
