"""I1.2: what is wrong with the summaries of a node, as data for the catalogue of mistakes (`fault` and its words)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from checks.i1_2.facts import SUMMARY_EVERY, TOPIC, TYPE, Trial
from checks.i1_2.reading import labelled
from checks.i1_2.summaries import Summary, is_in_time, last_due_count
from checks.i1_2.totals import total_as_rate
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Trace
from tutor.judge.wording import output_tail

Fault = dict[str, Any]

EVERY_MESSAGE = "summary-for-every-message"


def wrong_log(trace: Trace, fault: Fault) -> Observation:
    """The node's log says something that is not so."""
    return Symptom.WRONG_LOG.seen(trace, topic=TOPIC, type=TYPE, **fault)


def ended(trial: Trial, what: str) -> Observation:
    """The node ended, having met `what`."""
    return Symptom.ENDED.seen(trial.trace, answers=trial.spins, says=f"the node does not survive {what}")


def in_words(totals: range) -> str:
    """The totals that would be true: "30", "30 or 31", "50 to 59"."""
    if len(totals) < 3:
        return " or ".join(map(str, totals))
    return f"{totals[0]} to {totals[-1]}"


def find_wrong_count(summary: Summary, trial: Trial) -> Fault:
    """Why a summary does not state the true total, by what it states."""
    sent, last = summary.messages, trial.sent[summary.messages - 1]
    missed = sum(trial.missed(sent - 1))
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


def swapped(summary: Summary, trial: Trial) -> Fault:
    """The total is given where the rate should be, and so probably the rate where the total should be."""
    number = total_as_rate(summary, trial)
    assert number is not None
    return {"fault": "count-and-rate-swapped", "number": number.text}


def find_wrong_interval(summaries: Sequence[Summary], trial: Trial, messages: int) -> Fault | None:
    """What is wrong with when the summaries of the first `messages` messages come; None if nothing is."""
    due = range(SUMMARY_EVERY, messages + 1, SUMMARY_EVERY)
    when = [summary.messages for summary in summaries]
    if len(summaries) > 3 and len(summaries) >= 0.7 * messages:
        return too_many(len(summaries), messages) | {"fault": EVERY_MESSAGE}
    if len(summaries) > len(due) or any(summary.repetitions > 1 for summary in summaries):
        return too_many(sum(summary.repetitions for summary in summaries), messages)
    for number in due:
        candidates = [each for each in summaries if last_due_count(each.messages) == number]
        if not any(is_in_time(each, trial) for each in candidates):
            early = [each for each in when if number - SUMMARY_EVERY < each < number]
            late = [each for each in when if number < each < number + SUMMARY_EVERY]
            when_instead = f"one comes after {(early or late)[-1]}" if early or late else "and none comes soon after"
            return {"fault": "missing-summary", "what": f"there is none after {number} messages, {when_instead}"}
    return None


def too_many(summaries: int, messages: int) -> Fault:
    """More summaries than one for every ten messages."""
    return {"fault": "too-many-summaries", "summaries": summaries, "messages": messages}


def find_incomplete(summary: Summary, trial: Trial) -> Fault | None:
    """What is missing from a summary, or in the wrong place; None if nothing is."""
    first = trial.sent[0]
    recent = trial.sent[last_due_count(summary.messages) - 1 : summary.messages_at_end]
    if first.number not in summary.quoted:
        others = [number for number in summary.quoted if number not in {each.number for each in recent}]
        if others:
            quoted = f"Hello World: {others[0]}"
            return {"fault": "first-message-overwritten", "content": first.content, "quoted": quoted}
        is_cut = any("Hello World" in line.text for line in summary.lines)
        return {"fault": "first-message-missing", "content": first.content, "cut": is_cut}
    if not any(each.number in summary.quoted for each in recent):
        return {"fault": "last-message-missing", "what": f"“{recent[0].content}” is not in it"}
    labels = {(name, number) for line in summary.lines for name, number in labelled(line.text)}
    swapped = [("first", each.number) for each in recent if each.number != first.number]
    if ("last", first.number) in labels and labels.intersection(swapped) and ("first", first.number) not in labels:
        return {"fault": "first-and-last-swapped", "content": first.content}
    return None


def last_logs(trial: Trial) -> list[str]:
    """The last log messages; without any, the end of what was printed."""
    return [str(log) for log in trial.trace.logs[-6:]] or list(output_tail(trial.trace))
