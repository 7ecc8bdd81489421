"""I1.2: the verdict on `summary`: one for every ten messages, with the first and the last message's content."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from checks.i1_2_message_statistics import losses
from checks.i1_2_message_statistics.count import Fault, counts_truly, fails, true_total, unless_messages_are_lost
from checks.i1_2_message_statistics.log_lines import labelled, parse_log
from checks.i1_2_message_statistics.logged_summaries import Summary, count_complete, find_summaries
from checks.i1_2_message_statistics.plans import FAST_HZ, FAST_MESSAGES
from checks.i1_2_message_statistics.trial import OURS, SHOWN, SUMMARY_EVERY, Trial
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import LogRecord
from tutor.judge.verdict import Verdict, failed, passed, skipped, undecided

EXPECTED = f"one summary for every {SUMMARY_EVERY} messages, with the first and the last message's content"
EVERY_MESSAGE = "summary-for-every-message"

SLOWED_S = 0.5
"""If the node waited longer for a CPU, the machine may be to blame for missing summaries."""


@unless_messages_are_lost
def judge_summary(steady: Trial, jump: Trial, fast: Trial) -> Verdict:
    """Judge `summary`; messages lost at a fast rate are reported by `count`."""
    verdict = judge_slow_summary(steady, jump)
    if not verdict.passed or losses.find_lost(fast, steady) or not losses.is_summary_missing(fast, steady):
        return verdict
    if not losses.was_sent_fast_enough(fast) or fast.allowance_s > SLOWED_S:
        return undecided("to send messages fast")
    return failed(
        f"{EXPECTED}, at {FAST_HZ:g} a second, too",
        f"of {len(fast.sent)} messages, none since message {losses.count_summarised(fast, steady)}",
        fast.seen(Symptom.NOT_LOGGED, fault="fewer-summaries"),
        map(str, find_summaries(fast)[:SHOWN]),
    )


def judge_slow_summary(steady: Trial, jump: Trial) -> Verdict:
    """Judge `summary` by the messages that come slowly."""
    usual, late = find_summaries(steady), find_summaries(jump)
    if not usual:
        if (many := count_complete(steady)) > len(steady.sent) // SUMMARY_EVERY:
            return _fails_by_number(many, steady)
        return _fails_silent(steady)
    # A node that exits or miscounts from the jump on fails other criteria.
    survives_jump = jump.trace.exit is None and counts_truly(jump)
    judged = (steady, len(steady.sent)), (jump, len(jump.sent) if survives_jump else jump.before_break)
    for trial, messages in judged:
        summaries = [summary for summary in find_summaries(trial) if summary.messages <= messages]
        if (fault := find_wrong_interval(summaries, trial, messages)) is not None:
            if _are_timed_by_a_wrong_count(summaries):
                return skipped("not judged, because `count` did not pass: summaries are timed by a wrong count")
            return fails(EXPECTED, _describe_times(summaries, messages), trial, fault)
        for summary in summaries:
            if (fault := find_incomplete(summary)) is not None:
                return fails(EXPECTED, f"it is incomplete {summary}", trial, fault)
    if not survives_jump and jump.trace.exit is None and len(late) > len(jump.sent) // SUMMARY_EVERY + 1:
        return _fails_by_number(len(late), jump)
    return passed(EXPECTED, f"{len(usual)} for {len(steady.sent)} messages, with both contents", map(str, usual))


@losses.of_what_comes
def judge_fast_summary(fast: Trial) -> Verdict | None:
    """Judge `summary` by the fast stretch alone.

    Fail a node that responds but logs nothing about any message, one that logs far too many summaries, and one whose
    summaries all lack the same thing.
    """
    if not fast.lines:
        silent = fast.spins and len(fast.sent) >= FAST_MESSAGES and losses.was_sent_fast_enough(fast)
        return _fails_silent(fast) if silent else None
    summaries = losses.fast_summaries(fast)
    if not summaries:
        return None
    if all(summary.is_complete for summary in summaries) and len(summaries) >= 1.5 * len(fast.sent) / SUMMARY_EVERY:
        fault = find_wrong_interval(summaries, fast, len(fast.sent))
        apart = {after.messages - before.messages for before, after in pairwise(summaries)}
        # At different distances, some may be several that look like one because the messages came fast.
        if fault is None or (fault["fault"] != EVERY_MESSAGE and len(apart) > 1):
            return None
        return fails(EXPECTED, _describe_times(summaries, len(fast.sent)), fast, fault)
    if any(summary.messages % SUMMARY_EVERY > 1 for summary in summaries):  # perhaps timed by a wrong count
        return None
    missing = [find_incomplete(summary) for summary in summaries[1:]]  # the first may be complete
    last = missing[-1]
    if last is None or {fault and fault["fault"] for fault in missing} != {last["fault"]}:
        return None
    return fails(EXPECTED, f"it is incomplete {summaries[-1]}", fast, last)


def _fails_silent(trial: Trial) -> Verdict:
    """The node logs no summary, or is not there to log one."""
    return failed(EXPECTED, f"none, after {len(trial.sent)} messages", _see_no_summary(trial), trial.last_words)


def _see_no_summary(trial: Trial) -> Observation:
    idle = not trial.spins and not trial.lines
    if trial.trace.exit is not None or not trial.sent or idle:
        return trial.seen(Symptom.NOTHING_RECEIVED, stuck=trial.stuck, answers=trial.spins, ours=OURS)
    return trial.seen(
        Symptom.NOT_LOGGED,
        stuck=trial.stuck,
        answers=trial.spins,
        fault="no-summary",
        what="what the node has to say",
        recognise=lambda text: bool(parse_log(LogRecord(20, "", text, 0.0, 0.0), 1).quoted),
        at_end=trial.ending.output if trial.ending else (),
        logged=bool(trial.lines),
        only_debug=not trial.lines,
    )


def _fails_by_number(summaries: int, trial: Trial) -> Verdict:
    messages = len(trial.sent)
    observed = f"{summaries} summaries for {messages} messages"
    return fails(EXPECTED, observed, trial, too_many(summaries, messages), trial.last_words)


def _describe_times(summaries: Sequence[Summary], messages: int) -> str:
    when = ", ".join(str(summary.messages) for summary in summaries[:12])
    return f"summaries after {when or 'no'} messages, of {messages}"


def _are_timed_by_a_wrong_count(summaries: Sequence[Summary]) -> bool:
    """Whether each summary is timed by the node's own count, and that count is wrong.

    A single count may be right by chance: if a node counts one too many, its summary after 9 messages may come late,
    after the 10th.
    """
    by_its_count = all(summary.states(SUMMARY_EVERY * number) for number, summary in enumerate(summaries, start=1))
    return by_its_count and not all(map(true_total, summaries))


def find_wrong_interval(summaries: Sequence[Summary], trial: Trial, messages: int) -> Fault | None:
    """What is wrong with when the summaries of the first `messages` messages come; None if nothing is."""
    due = range(SUMMARY_EVERY, messages + 1, SUMMARY_EVERY)
    when = [summary.messages for summary in summaries]
    if len(summaries) > 3 and len(summaries) >= 0.7 * messages:
        return too_many(len(summaries), messages, EVERY_MESSAGE)
    if len(summaries) > len(due) or any(summary.repetitions > 1 for summary in summaries):
        return too_many(sum(summary.repetitions for summary in summaries), messages)
    for number in due:
        if not any(summary.due == number and summary.is_in_time for summary in summaries):
            early = [count for count in when if number - SUMMARY_EVERY < count < number]
            late = [count for count in when if number < count < number + SUMMARY_EVERY]
            when_instead = f"one comes after {(early or late)[-1]}" if early or late else "and none comes soon after"
            return {"fault": "missing-summary", "what": f"there is none after {number} messages, {when_instead}"}
    return None


def too_many(summaries: int, messages: int, fault: str = "too-many-summaries") -> Fault:
    """More summaries than one for every ten messages."""
    return {"fault": fault, "summaries": summaries, "messages": messages}


def find_incomplete(summary: Summary) -> Fault | None:
    """What is missing from a summary, or in the wrong place; None if nothing is."""
    first, quoted = summary.trial.sent[0], summary.quoted
    recent = {message.number for message in summary.recent}
    if first.number not in quoted:
        others = [number for number in quoted if number not in recent]
        if others:
            found = f"Hello World: {others[0]}"
            return {"fault": "first-message-overwritten", "content": first.content, "quoted": found}
        is_cut = any("Hello World" in line.text for line in summary.lines)
        return {"fault": "first-message-missing", "content": first.content, "cut": is_cut}
    if not recent.intersection(quoted):
        return {"fault": "last-message-missing", "what": f"“{summary.recent[0].content}” is not in it"}
    labels = {label for line in summary.lines for label in labelled(line.text)}
    swapped = {("first", number) for number in recent if number != first.number}
    if ("last", first.number) in labels and labels & swapped and ("first", first.number) not in labels:
        return {"fault": "first-and-last-swapped", "content": first.content}
    return None
