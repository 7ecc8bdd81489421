"""I1.2: the verdicts on `count`, `rate`, `summary` and `shutdown`."""

from __future__ import annotations

from collections.abc import Sequence

from checks.i1_2 import backlog, rates, slowness, steps
from checks.i1_2.facts import FAST_HZ, FAST_MESSAGES, OURS, STALL_S, SUMMARY_EVERY, TOPIC, Trial
from checks.i1_2.reading import Number, labelled, parse_log
from checks.i1_2.summaries import (
    Summary,
    count_complete,
    find_summaries,
    is_complete,
    is_in_time,
    last_due_count,
    possible_totals,
)
from tutor.judge import causes, ending
from tutor.judge.causes import slips
from tutor.judge.rewriting.node import started_node
from tutor.judge.trace import Level, LogRecord
from tutor.judge.verdict import Cause, Verdict, failed, passed, skipped, undecided

EXPECTED_SUMMARY = f"one summary for every {SUMMARY_EVERY} messages, with the first and the last message's content"
BUSY_S = 0.5
"""If the node waited longer for a CPU, missing summaries may be the machine's fault."""

EXPECTED_COUNT = "each summary states how many messages have come"
NO_SUMMARY = "not judged, because there is no summary to read: see `summary`"


def judge_count(steady: Trial, jump: Trial, fast: Trial) -> Verdict:
    """Judge `count`."""
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
        slowness.diagnose_lost(fast.trace, lost),
        [str(summary) for summary in find_summaries(fast)[:6]],
    )


def judge_slow_count(steady: Trial, jump: Trial) -> Verdict:
    """Judge `count` by the messages that come slowly."""
    expected = EXPECTED_COUNT
    if not find_summaries(steady):
        return skipped(NO_SUMMARY)
    seen = [(trial, summary) for trial in (steady, jump) for summary in find_summaries(trial)]
    wrong = [(trial, summary) for trial, summary in seen if not true_total(summary, trial)]
    if wrong:
        trial, summary = wrong[-1]  # after the jump, N and the count differ most, so that the cause is clearest
        return failed(
            f"{expected}: {' or '.join(map(str, possible_totals(summary, trial)))}",
            f"the summary that came after {summary.messages} messages does not say so",
            _diagnose_count(summary, trial),
            [str(other) for _, other in seen],
        )
    if all(_total_as_rate(summary, trial) for trial, summary in seen):
        trial, summary = seen[-1]
        return failed(
            expected,
            f"the summary that came after {summary.messages} messages does not say so",
            _diagnose_swapped(summary, trial),
            [str(other) for _, other in seen],
        )
    stated = ", ".join(str(true_total(summary, trial)) for trial, summary in seen)
    return passed(expected, f"{len(seen)} summaries state {stated}", [str(summary) for _, summary in seen])


def counts_truly(*trials: Trial) -> bool:
    """Whether every summary states the true total."""
    return all(true_total(summary, trial) for trial in trials for summary in find_summaries(trial))


def true_total(summary: Summary, trial: Trial, *, before: int = 0) -> int:
    """The true total that a summary states, if the first `before` messages do not count; 0 if it states none.

    A summary that is logged later than its message must not quote a newer one; which older message it quotes as the
    last does not matter here. If it also quotes the message that it counted last, it may be arbitrarily late.
    """
    true = possible_totals(summary, trial, before=before)
    for total in true:
        late = summary.messages > before + total
        if summary.states(total) and (not late or _may_be_made_after(before + total, summary, trial, before=before)):
            return total
    earlier_totals = {
        *range(SUMMARY_EVERY, true.start, SUMMARY_EVERY),
        *range(max(1, true.start - SUMMARY_EVERY), true.start),
    }
    held_back = [total for total in sorted(earlier_totals) if summary.states(total)]
    return next((t for t in held_back if _is_made_after(before + t, summary, trial, before=before)), 0)


def _total_as_rate(summary: Summary, trial: Trial) -> Number | None:
    """The number that states the true total, if its unit says that it is a rate; None if another one states it, too."""
    stating = [number for number in summary.numbers if true_total(summary, trial) in number.values]
    return stating[0] if stating and all(number.per_second for number in stating) else None


def _diagnose_swapped(summary: Summary, trial: Trial) -> Cause:
    number = _total_as_rate(summary, trial)
    assert number is not None
    return Cause(
        "count and rate swapped",
        f"it gives {number.text}, which is how many messages came, as messages per second",
        steps.count_messages(trial.trace) or "swap the two values: the count is self.total_count",
    )


def _may_be_made_after(messages: int, summary: Summary, trial: Trial, *, before: int) -> bool:
    """Whether its quotations are consistent with a summary that was made after this many messages."""
    newer = {each.number for each in trial.sent[messages : summary.messages_at_end]}
    later = newer.intersection(_quoted_without_first(summary, trial, before=before))
    return not later or _is_made_after(messages, summary, trial, before=before)


def _is_made_after(messages: int, summary: Summary, trial: Trial, *, before: int) -> bool:
    """Whether the summary quotes the last of this many messages, and none that came later.

    A new publisher repeats some numbers; one that had come before does not count as later.
    """
    sent, quoted = trial.sent, _quoted_without_first(summary, trial, before=before)
    newer = {each.number for each in sent[messages : summary.messages_at_end]} - {
        each.number for each in sent[:messages]
    }
    return sent[messages - 1].number in quoted and not newer.intersection(quoted)


def _quoted_without_first(summary: Summary, trial: Trial, *, before: int) -> list[int]:
    """The numbers that the summary quotes, without one quotation of a first message."""
    quoted = list(summary.quoted)
    for first in {trial.sent[0].number, trial.sent[before].number}.intersection(quoted):
        quoted.remove(first)
    return quoted


def _diagnose_count(summary: Summary, trial: Trial) -> Cause:
    name, text, words = _miscounted(summary, trial)
    return Cause(name, text, steps.count_messages(trial.trace) or words)


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


def judge_rate(steady: Trial, jump: Trial) -> Verdict:
    summaries = [summary for summary in find_summaries(steady) if summary.messages > 1]  # one message gives no rate yet
    if not summaries:
        return skipped(NO_SUMMARY)
    allowed = [rates.true_rates(summary, steady) for summary in summaries]
    low, high = min(each.low for each in allowed), max(each.high for each in allowed)
    expected = f"each summary states the messages per second: {rates.sent_hz(steady):.2f}, from {low:.1f} to {high:.1f}"
    evidence = [str(summary) for summary in summaries]
    stated = rates.find_stated_rates(summaries, allowed, jump)
    if stated is not None and all(_total_as_rate(summary, steady) for summary in summaries):
        wrong = summaries[-1]
        observed = f"after {wrong.messages} messages it states {', '.join(n.text for n in wrong.numbers)}"
        return failed(expected, observed, _diagnose_swapped(wrong, steady), evidence)
    if stated is None:
        wrong = next((r for r, a in zip(summaries, allowed, strict=True) if not a.among(r)), summaries[-1])
        return failed(
            expected,
            f"after {wrong.messages} messages it states {', '.join(n.text for n in wrong.numbers) or 'no number'}",
            rates.diagnose_wrong_rate(wrong, summaries, steady),
            evidence,
        )
    if rates.is_doubtful_rate(stated, summaries, steady):
        return undecided("to send messages at an even rate")
    return passed(expected, f"{', '.join(number.text for number in stated)} messages per second", evidence)


def judge_summary(steady: Trial, jump: Trial, fast: Trial) -> Verdict:
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
        _diagnose_fewer_summaries(fast),
        [str(summary) for summary in find_summaries(fast)[:6]],
    )


def _diagnose_fewer_summaries(fast: Trial) -> Cause:
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


def judge_slow_summary(steady: Trial, jump: Trial) -> Verdict:
    """Judge `summary` by the messages that come slowly."""
    expected = EXPECTED_SUMMARY
    if not find_summaries(steady):
        if (many := count_complete(steady)) > len(steady.sent) // SUMMARY_EVERY:
            text = f"{many} summaries for {len(steady.sent)} messages"
            again = Cause("too many summaries", "one summary is written again and again", _every_ten(steady))
            return failed(expected, text, again, _logged(steady))
        return failed(
            expected, f"none, after {len(steady.sent)} messages", diagnose_no_summary(steady), _logged(steady)
        )
    # A node that exits or miscounts from the jump on fails other criteria.
    survives_jump = jump.trace.exit is None and counts_truly(jump)
    for trial, messages in ((steady, len(steady.sent)), (jump, len(jump.sent) if survives_jump else jump.before_break)):
        summaries = [summary for summary in find_summaries(trial) if summary.messages <= messages]
        evidence = [str(summary) for summary in summaries[:8]]
        if (cause := _diagnose_interval(summaries, trial, messages)) is not None:
            if _counts_wrongly(summaries, trial):
                return skipped("not judged, because `count` did not pass: summaries are timed by a wrong count")
            observed = (
                f"summaries after {', '.join(str(summary.messages) for summary in summaries[:12]) or 'no'} messages"
            )
            return failed(expected, f"{observed}, of {messages}", cause, evidence)
        for summary in summaries:
            if (cause := _diagnose_incomplete_summary(summary, trial)) is not None:
                return failed(expected, f"it is incomplete {summary}", cause, evidence)
    complete = find_summaries(steady)
    return passed(
        expected,
        f"{len(complete)} for {len(steady.sent)} messages, with both contents",
        [str(summary) for summary in complete],
    )


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
        _diagnose_count(last, fast),
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
        return failed(EXPECTED_SUMMARY, observed, diagnose_no_summary(fast), _logged(fast)) if silent else None
    summaries = _fast_summaries(fast)
    if not summaries:
        return None
    evidence = [str(summary) for summary in summaries[:8]]
    whole = all(is_complete(summary, fast) for summary in summaries)
    if whole and len(summaries) >= 1.5 * len(fast.sent) / SUMMARY_EVERY:
        when = ", ".join(str(summary.messages) for summary in summaries[:12])
        cause = _diagnose_interval(summaries, fast, len(fast.sent))
        observed = f"summaries after {when} messages, of {len(fast.sent)}"
        return failed(EXPECTED_SUMMARY, observed, cause, evidence) if cause else None
    if any(summary.messages % SUMMARY_EVERY > 1 for summary in summaries):  # perhaps timed by a wrong count
        return None
    missing = [_diagnose_incomplete_summary(summary, fast) for summary in summaries[1:]]  # the first may be complete
    cause = missing[-1]
    if cause is None or {each and each.name for each in missing} != {cause.name}:
        return None
    return failed(EXPECTED_SUMMARY, f"it is incomplete {summaries[-1]}", cause, evidence)


def _fast_summaries(fast: Trial) -> Sequence[Summary]:
    """The summaries of a fast stretch; none if some may be missing, late or torn because the messages came fast.

    Nor if there are two subscriptions that may log each message twice: the slow messages show the cause of that better.
    """
    summaries = find_summaries(fast)
    whole = (
        len(fast.sent) >= FAST_MESSAGES
        and backlog.was_sent_fast_enough(fast)
        and len(summaries) >= len(fast.sent) // SUMMARY_EVERY
    )
    prompt = fast.spins and fast.allowance_s < STALL_S and not backlog.messages_behind(fast)
    alone = sum(each.topic == TOPIC for each in fast.trace.graph.subscriptions) == 1
    return summaries if whole and prompt and alone else ()


def _diagnose_interval(summaries: Sequence[Summary], trial: Trial, messages: int) -> Cause | None:
    due = range(SUMMARY_EVERY, messages + 1, SUMMARY_EVERY)
    when = [summary.messages for summary in summaries]
    if len(summaries) > 3 and len(summaries) >= 0.7 * messages:
        return Cause(
            "summary for every message", f"{len(summaries)} summaries for {messages} messages", _every_ten(trial)
        )
    if len(summaries) > len(due) or any(summary.repetitions > 1 for summary in summaries):
        return Cause(
            "too many summaries",
            f"{sum(summary.repetitions for summary in summaries)} summaries for {messages} messages",
            _every_ten(trial),
        )
    for number in due:
        candidates = [each for each in summaries if last_due_count(each.messages) == number]
        if not any(is_in_time(each, trial) for each in candidates):
            early = [each for each in when if number - SUMMARY_EVERY < each < number]
            late = [each for each in when if number < each < number + SUMMARY_EVERY]
            when_instead = f"it comes after {(early or late)[-1]}" if early or late else "and none comes later"
            return Cause("missing summary", f"there is none after {number} messages, {when_instead}", _every_ten(trial))
    return None


def _every_ten(trial: Trial) -> str:
    """The step towards one summary for every ten messages."""
    return steps.summarise_every_ten(trial.trace) or (
        f"if self.total_count % {SUMMARY_EVERY} == 0: write the summary, in the callback, after counting"
    )


def _counts_wrongly(summaries: Sequence[Summary], trial: Trial) -> bool:
    """Whether each summary is timed by the node's own count, and that count is wrong.

    A single count may be right by chance: if a node counts one too many, its summary after 9 messages may come late,
    after the 10th.
    """
    by_its_count = all(summary.states(SUMMARY_EVERY * number) for number, summary in enumerate(summaries, start=1))
    return by_its_count and any(not true_total(summary, trial) for summary in summaries)


def _diagnose_incomplete_summary(summary: Summary, trial: Trial) -> Cause | None:
    first = trial.sent[0]
    recent = trial.sent[last_due_count(summary.messages) - 1 : summary.messages_at_end]
    if first.number not in summary.quoted:
        others = [number for number in summary.quoted if number not in {each.number for each in recent}]
        if others:
            return Cause(
                "first message overwritten",
                f"“{first.content}” was the first one, but it quotes “Hello World: {others[0]}”",
                steps.keep_first_message(trial.trace)
                or "set self.first_message only while it is None, and never again",
            )
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


def diagnose_no_summary(trial: Trial) -> Cause:
    """Find out why the node logs no summary."""
    trace = trial.trace
    if trace.exit is not None or not trial.sent or not (trial.lines or trial.spins):
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
    raised = None if trial.lines else slips.diagnose_raised_level(started_node(trace), Level.FATAL)
    return raised or Cause(
        "no summary",
        "none of its log messages sums up the messages" if trial.lines else "no log message follows from a message",
        steps.summarise_every_ten(trace)
        or f"count in the callback; if self.total_count % {SUMMARY_EVERY} == 0: self.get_logger().info(...) with the "
        "count, the rate, the first and the last message",
    )


def _as_log(text: str) -> LogRecord:
    return LogRecord(20, "", text, 0.0, 0.0)


def _logged(trial: Trial) -> list[str]:
    return [str(log) for log in trial.trace.logs[-6:]] or list(causes.output_tail(trial.trace))


def judge_shutdown(fast: Trial) -> Verdict:
    return ending.judge_ending(fast.trace, fast.ending)
