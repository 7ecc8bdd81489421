"""I1.2: why a summary is missing, incomplete or wrong."""

from __future__ import annotations

import ast
from collections.abc import Sequence

from checks.i1_2 import steps
from checks.i1_2.facts import OURS, SUMMARY_EVERY, Trial
from checks.i1_2.reading import labelled, parse_log
from checks.i1_2.summaries import Summary, is_in_time, last_due_count
from checks.i1_2.totals import total_as_rate
from tutor.judge import causes
from tutor.judge.causes import slips
from tutor.judge.causes.unawaited import diagnose_unawaited
from tutor.judge.causes.unserved import diagnose_unserved
from tutor.judge.edits import replace_node
from tutor.judge.rewriting.node import NodeFile, find_in_files
from tutor.judge.trace import Level, LogRecord
from tutor.judge.verdict import Cause

EVERY_MESSAGE = "summary for every message"


def diagnose_end(trial: Trial, what: str) -> Cause:
    """Why the node ended, having met `what`."""
    ended = Cause("exit at once", f"the node does not survive {what}", "keep it running")
    return steps.keep_node_up(trial.trace, causes.diagnose_process(trial.trace) or ended)


def diagnose_count(summary: Summary, trial: Trial) -> Cause:
    """Why a summary does not state the true total."""
    if (unformatted := _diagnose_missing_f(summary, trial)) is not None:
        return unformatted
    name, text, words = _miscounted(summary, trial)
    return Cause(name, text, steps.count_messages(trial.trace) or words)


def _diagnose_missing_f(summary: Summary, trial: Trial) -> Cause | None:
    texts = [line.text for line in summary.lines]
    return find_in_files(trial.trace, lambda file: slips.diagnose_missing_f(file, texts))


def _miscounted(summary: Summary, trial: Trial) -> tuple[str, str, str]:
    """Return name and text of the cause, and a step in words."""
    sent, last = summary.messages, trial.sent[summary.messages - 1].number
    missed = sum(trial.missed(sent - 1))
    if missed and summary.states(sent + missed):
        return (
            "missed messages counted",
            f"it says {sent + missed}, but {missed} of these were never sent",
            "count each call of the callback, and nothing else: self.total_count += 1",
        )
    if (trial.before_break or trial.sent[0].number > 1) and (summary.states(last) or summary.states(last + 1)):
        return (
            "number taken for the count",
            f"it states the N of “Hello World: {last}”, not how many messages came",
            "a node that starts late misses messages, so N is not the count: self.total_count += 1 in the callback",
        )
    near = next((sent + by for by in (1, -1) if summary.states(sent + by)), None)
    if near is not None:
        return (
            "off by one",
            f"it says {near} after {sent} messages",
            "start at 0, and count each message once, before you write the summary",
        )
    if not summary.numbers:
        return ("no count", "there is no number in it", "put self.total_count into the text of the summary")
    return (
        "wrong count",
        f"none of its numbers ({', '.join(number.text for number in summary.numbers)}) is {sent}",
        "self.total_count += 1 in the callback, once for each message, and put it into the summary",
    )


def diagnose_swapped(summary: Summary, trial: Trial) -> Cause:
    """The total is given where the rate should be, and so probably the rate where the total should be."""
    number = total_as_rate(summary, trial)
    assert number is not None
    return Cause(
        "count and rate swapped",
        f"it gives {number.text}, which is how many messages came, as messages per second",
        steps.count_messages(trial.trace) or "swap the two values: the count is self.total_count",
    )


def diagnose_interval(summaries: Sequence[Summary], trial: Trial, messages: int) -> Cause | None:
    """What is wrong with when the summaries of the first `messages` messages come; None if nothing is."""
    due = range(SUMMARY_EVERY, messages + 1, SUMMARY_EVERY)
    when = [summary.messages for summary in summaries]
    if len(summaries) > 3 and len(summaries) >= 0.7 * messages:
        return Cause(EVERY_MESSAGE, f"{len(summaries)} summaries for {messages} messages", every_ten(trial))
    if len(summaries) > len(due) or any(summary.repetitions > 1 for summary in summaries):
        return Cause(
            "too many summaries",
            f"{sum(summary.repetitions for summary in summaries)} summaries for {messages} messages",
            every_ten(trial),
        )
    for number in due:
        candidates = [each for each in summaries if last_due_count(each.messages) == number]
        if not any(is_in_time(each, trial) for each in candidates):
            early = [each for each in when if number - SUMMARY_EVERY < each < number]
            late = [each for each in when if number < each < number + SUMMARY_EVERY]
            when_instead = f"it comes after {(early or late)[-1]}" if early or late else "and none comes later"
            return Cause("missing summary", f"there is none after {number} messages, {when_instead}", every_ten(trial))
    return None


def every_ten(trial: Trial) -> str:
    """The step towards one summary for every ten messages."""
    return steps.summarise_every_ten(trial.trace) or (
        f"if self.total_count % {SUMMARY_EVERY} == 0: write the summary, in the callback, after counting"
    )


def diagnose_incomplete_summary(summary: Summary, trial: Trial) -> Cause | None:
    """What is missing from a summary, or in the wrong place; None if nothing is."""
    first = trial.sent[0]
    if first.number not in summary.quoted and (unformatted := _diagnose_missing_f(summary, trial)) is not None:
        return unformatted
    recent = trial.sent[last_due_count(summary.messages) - 1 : summary.messages_at_end]
    if first.number not in summary.quoted:
        if (shared := find_in_files(trial.trace, slips.diagnose_shared_object)) is not None:
            return shared
        others = [number for number in summary.quoted if number not in {each.number for each in recent}]
        if others:
            return Cause(
                "first message overwritten",
                f"“{first.content}” was the first one, but it quotes “Hello World: {others[0]}”",
                steps.keep_first_message(trial.trace)
                or "set self.first_message only while it is None, and never again",
            )
        is_cut = any("Hello World" in line.text for line in summary.lines)
        if is_cut and (cut := find_in_files(trial.trace, _diagnose_slice)) is not None:
            return cut
        return Cause(
            "first message missing",
            f"“{first.content}” is not in it",
            steps.summarise_every_ten(trial.trace)
            or "keep the first message's data in self.first_message, and put it into the summary",
        )
    if not any(each.number in summary.quoted for each in recent):
        return Cause(
            "last message missing",
            f"“{recent[0].content}” is not in it",
            steps.summarise_every_ten(trial.trace)
            or "self.last_message = msg.data for each message, before you write the summary",
        )
    labels = {(name, number) for line in summary.lines for name, number in labelled(line.text)}
    swapped = [("first", each.number) for each in recent if each.number != first.number]
    if ("last", first.number) in labels and labels.intersection(swapped) and ("first", first.number) not in labels:
        return Cause(
            "first and last swapped",
            f"it calls “{first.content}” the last one, and the last one the first",
            steps.summarise_every_ten(trial.trace)
            or "put self.first_message after “first”, and the message that has just come after “last”",
        )
    return None


def _diagnose_slice(file: NodeFile) -> Cause | None:
    """Whether the file cuts a text to its first characters."""
    for node in file.nodes:
        match node:
            case ast.Subscript(slice=ast.Slice(lower=None, upper=ast.expr() as upper, step=None), value=value) if (
                not ast.unparse(upper).startswith("-")
            ):
                step = file.step([replace_node(file.text, node, ast.unparse(value))])
                text = f"line {node.lineno}: {ast.unparse(node)} cuts the text before its number"
                return Cause("content cut off", text, step) if step else None
    return None


def diagnose_no_summary(trial: Trial) -> Cause:
    """Find out why the node logs no summary."""
    trace = trial.trace
    # A node that is stuck before it spins may log all the time nevertheless.
    spins = trial.spins or (bool(trial.lines) and causes.diagnose_not_spinning(trace, trial.stuck, "") is None)
    if trace.exit is not None or not trial.sent or not spins:
        return steps.keep_node_up(
            trace, causes.diagnose_nothing_received(trace, OURS, answers=trial.spins, stuck=trial.stuck)
        )
    printed = causes.diagnose_printed(
        trace,
        lambda text: bool(parse_log(_as_log(text), 1).quoted),
        "what the node has to say",
        after=trial.ending.output if trial.ending else (),
    )
    if printed is not None:
        return printed
    if not trial.lines:
        raised = find_in_files(trace, lambda file: slips.diagnose_raised_level(file, Level.FATAL))
        if (silent := raised or diagnose_unawaited(trace) or diagnose_unserved(trace)) is not None:
            return silent
    return Cause(
        "no summary",
        "none of its log messages sums up the messages" if trial.lines else "no log message follows from a message",
        steps.summarise_every_ten(trace)
        or f"count in the callback; if self.total_count % {SUMMARY_EVERY} == 0: self.get_logger().info(...) with the "
        "count, the rate, the first and the last message",
    )


def diagnose_fewer_summaries(fast: Trial) -> Cause:
    """Find out why there are fewer summaries when messages come fast."""
    throttled = steps.remove_throttle(fast.trace)
    text = "most of them are left out when messages come fast"
    if throttled is not None:
        return Cause("log throttled", f"{text}: throttle_duration_sec lets one through in that many seconds", throttled)
    return Cause(
        "missing summary",
        text,
        steps.summarise_every_ten(fast.trace)
        or "write the summary in the callback, whenever the count is a multiple of ten",
    )


def _as_log(text: str) -> LogRecord:
    return LogRecord(20, "", text, 0.0, 0.0)


def last_logs(trial: Trial) -> list[str]:
    """The last log messages; without any, the end of what was printed."""
    return [str(log) for log in trial.trace.logs[-6:]] or list(causes.output_tail(trial.trace))
