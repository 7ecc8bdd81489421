"""I1.2: what must have been seen while N rises by one."""

from __future__ import annotations

from collections.abc import Sequence

from checks.i1_2 import backlog, rates, slowness, steps
from checks.i1_2.facts import EVERY, FAST_HZ, FAST_MESSAGES, OURS, STALL_S, TOPIC, Trial
from checks.i1_2.reading import labelled, read
from checks.i1_2.summaries import Summary, count_complete, find_summaries, in_time, is_complete, milestone, totals
from tutor.judge import causes, ending
from tutor.judge.trace import LogRecord
from tutor.judge.verdict import Cause, Verdict, failed, passed, skipped, undecided

EXPECTED_SUMMARY = f"one summary for every {EVERY} messages, with the first and the last message's content"
BUSY_S = 0.5
"""Where the machine held up the node or us for longer, fewer summaries may be its doing."""

EXPECTED_COUNT = "each summary states how many messages have come"
NO_SUMMARY = "not judged, because there is no summary to read: see `summary`"


def judge_count(steady: Trial, jump: Trial, fast: Trial) -> Verdict:
    """Judge `count`."""
    verdict = judge_slow_count(steady, jump)
    if not verdict.passed:
        return verdict
    lost = backlog.find_lost(fast, steady)
    if lost.excused if lost else not backlog.fast_enough(fast):
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
    """Judge what `count` asks for where the messages come slowly."""
    expected = EXPECTED_COUNT
    if not find_summaries(steady):
        return skipped(NO_SUMMARY)
    seen = [(trial, summary) for trial in (steady, jump) for summary in find_summaries(trial)]
    wrong = [(trial, summary) for trial, summary in seen if not true_total(summary, trial)]
    if wrong:
        trial, summary = wrong[-1]  # after the jump, N and the count are far apart: there the cause shows best
        return failed(
            f"{expected}: {' or '.join(map(str, totals(summary, trial)))}",
            f"the summary that came after {summary.messages} messages does not say so",
            _diagnose_count(summary, trial),
            [str(other) for _, other in seen],
        )
    stated = ", ".join(str(true_total(summary, trial)) for trial, summary in seen)
    return passed(expected, f"{len(seen)} summaries state {stated}", [str(summary) for _, summary in seen])


def counts_truly(*trials: Trial) -> bool:
    """Whether every summary states the true total."""
    return all(true_total(summary, trial) for trial in trials for summary in find_summaries(trial))


def true_total(summary: Summary, trial: Trial, *, before: int = 0) -> int:
    """The true total that a summary states, when the first `before` messages do not count; 0 where it states none.

    One that comes later than its message must quote no newer one: which of the older ones it quotes as the last is no
    matter of the count. One that also quotes the message that it has counted last may be as late as it likes.
    """
    true = totals(summary, trial, before=before)
    for total in true:
        late = summary.messages > before + total
        if summary.states(total) and (not late or _may_be_of(before + total, summary, trial, before=before)):
            return total
    before_that = {*range(EVERY, true.start, EVERY), *range(max(1, true.start - EVERY), true.start)}
    held_back = [total for total in sorted(before_that) if summary.states(total)]
    return next((t for t in held_back if _is_of(before + t, summary, trial, before=before)), 0)


def _may_be_of(messages: int, summary: Summary, trial: Trial, *, before: int) -> bool:
    """Whether nothing that it quotes tells against its being made when this many messages had come."""
    newer = {each.number for each in trial.sent[messages : summary.until]}
    later = newer.intersection(_quoted_but_first(summary, trial, before=before))
    return not later or _is_of(messages, summary, trial, before=before)


def _is_of(messages: int, summary: Summary, trial: Trial, *, before: int) -> bool:
    """Whether it quotes the last of this many messages, and what it quotes had come by then.

    A new publisher sends some numbers once more: what was there before is none of the newer ones.
    """
    sent, quoted = trial.sent, _quoted_but_first(summary, trial, before=before)
    newer = {each.number for each in sent[messages : summary.until]} - {each.number for each in sent[:messages]}
    return sent[messages - 1].number in quoted and not newer.intersection(quoted)


def _quoted_but_first(summary: Summary, trial: Trial, *, before: int) -> list[int]:
    """What it quotes, without a first message."""
    quoted = list(summary.quoted)
    for first in {trial.sent[0].number, trial.sent[before].number}.intersection(quoted):
        quoted.remove(first)
    return quoted


def _diagnose_count(summary: Summary, trial: Trial) -> Cause:
    name, text, words = _miscounted(summary, trial)
    return Cause(name, text, steps.count_messages(trial.trace) or words)


def _miscounted(summary: Summary, trial: Trial) -> tuple[str, str, str]:
    """The name of the cause, what it says, and a step in words."""
    sent, last = summary.messages, trial.sent[summary.messages - 1].number
    missed = sum(trial.missed(sent - 1))
    if missed and summary.states(sent + missed):
        return (
            "missed messages counted",
            f"it says {sent + missed}, but {missed} of these were never sent",
            "count each call of the callback, and nothing else: self.total_count += 1",
        )
    if (trial.breaks or trial.sent[0].number > 1) and (summary.states(last) or summary.states(last + 1)):
        return (
            "number taken for the count",
            f"it states the N of “Hello World: {last}”, not how many messages came",
            "anyone who starts late hears the N of others: count yourself, self.total_count += 1 in the callback",
        )
    near = next((sent + by for by in (1, -1) if summary.states(sent + by)), None)
    if near is not None:
        return (
            "off by one",
            f"it says {near} after {sent} messages",
            "begin with 0, and count each message once, before you write the summary",
        )
    if not summary.numbers:
        return ("no count", "there is no number in it", "put self.total_count into the text of the summary")
    return (
        "wrong count",
        f"none of its numbers ({', '.join(number.text for number in summary.numbers)}) is {sent}",
        "self.total_count += 1 in the callback, once for each message, and put it into the summary",
    )


def judge_rate(steady: Trial, jump: Trial) -> Verdict:
    summaries = [summary for summary in find_summaries(steady) if summary.messages > 1]  # one message has no rate yet
    if not summaries:
        return skipped(NO_SUMMARY)
    allowed = [rates.true_rates(summary, steady) for summary in summaries]
    low, high = min(each.low for each in allowed), max(each.high for each in allowed)
    expected = f"each summary states the messages per second: {rates.sent_hz(steady):.2f}, from {low:.1f} to {high:.1f}"
    evidence = [str(summary) for summary in summaries]
    stated = rates.stated(summaries, allowed, jump)
    if stated is None:
        wrong = next((r for r, a in zip(summaries, allowed, strict=True) if not a.among(r)), summaries[-1])
        return failed(
            expected,
            f"after {wrong.messages} messages it states {', '.join(n.text for n in wrong.numbers) or 'no number'}",
            rates.diagnose_wrong_rate(wrong, summaries, steady),
            evidence,
        )
    if rates.doubtful(stated, summaries, steady):
        return undecided("to send messages at an even rate")
    return passed(expected, f"{', '.join(number.text for number in stated)} messages per second", evidence)


def judge_summary(steady: Trial, jump: Trial, fast: Trial) -> Verdict:
    verdict = judge_slow_summary(steady, jump)
    if not verdict.passed or backlog.find_lost(fast, steady) is not None:  # `count` reports what is lost
        return verdict
    if not backlog.missing_summary(fast, steady):
        return verdict
    if not backlog.fast_enough(fast) or fast.allowance_s > BUSY_S:
        return undecided("to send messages fast")
    return failed(
        f"{EXPECTED_SUMMARY}, at {FAST_HZ:g} a second, too",
        f"of {len(fast.sent)} messages, none since message {backlog.count_summarised(fast, steady)}",
        _diagnose_fewer_summaries(fast),
        [str(summary) for summary in find_summaries(fast)[:6]],
    )


def _diagnose_fewer_summaries(fast: Trial) -> Cause:
    """Why there are fewer summaries when messages come fast."""
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
    """Judge what `summary` asks for where the messages come slowly."""
    expected = EXPECTED_SUMMARY
    if not find_summaries(steady):
        if (many := count_complete(steady)) > len(steady.sent) // EVERY:
            text = f"{many} summaries for {len(steady.sent)} messages"
            again = Cause("too many summaries", "one summary is written again and again", _every_ten(steady))
            return failed(expected, text, again, _logged(steady))
        return failed(
            expected, f"none, after {len(steady.sent)} messages", diagnose_no_summary(steady), _logged(steady)
        )
    # A node that ends with the jump, or miscounts from then on, breaks other criteria.
    all_along = jump.trace.exit is None and counts_truly(jump)
    for trial, messages in ((steady, len(steady.sent)), (jump, len(jump.sent) if all_along else jump.breaks)):
        summaries = [summary for summary in find_summaries(trial) if summary.messages <= messages]
        evidence = [str(summary) for summary in summaries[:8]]
        if (cause := _diagnose_interval(summaries, trial, messages)) is not None:
            if _counts_wrongly(summaries, trial):
                return skipped("not judged, because `count` did not pass: it sums up by a count that is not true")
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
    """Judge `count` by the fast stretch alone: whether none of its summaries states anything like the true total.

    What a node that lags behind may say, or one whose summary waits for a timer, is no evidence here.
    """
    summaries = _fast_summaries(fast)
    if not summaries or not all(is_complete(summary, fast) for summary in summaries):
        return None
    if any(summary.states(total) for summary in summaries for total in range(EVERY, summary.until + 1, EVERY)):
        return None
    if any(any(map(summary.states, totals(summary, fast))) for summary in summaries):
        return None
    last = summaries[-1]
    return failed(
        f"{EXPECTED_COUNT}: {' or '.join(map(str, totals(last, fast)))}",
        f"the summary that came after {last.messages} messages does not say so",
        _diagnose_count(last, fast),
        [str(summary) for summary in summaries],
    )


def judge_fast_summary(fast: Trial) -> Verdict | None:
    """Judge `summary` by the fast stretch alone.

    It fails where the node takes part in all and logs nothing of any message; where it logs far too many summaries;
    and where the same is missing from each.
    """
    if not fast.lines:
        silent = fast.spins and len(fast.sent) >= FAST_MESSAGES and backlog.fast_enough(fast)
        observed = f"none, after {len(fast.sent)} messages"
        return failed(EXPECTED_SUMMARY, observed, diagnose_no_summary(fast), _logged(fast)) if silent else None
    summaries = _fast_summaries(fast)
    if not summaries:
        return None
    evidence = [str(summary) for summary in summaries[:8]]
    whole = all(is_complete(summary, fast) for summary in summaries)
    if whole and len(summaries) >= 1.5 * len(fast.sent) / EVERY:
        when = ", ".join(str(summary.messages) for summary in summaries[:12])
        cause = _diagnose_interval(summaries, fast, len(fast.sent))
        observed = f"summaries after {when} messages, of {len(fast.sent)}"
        return failed(EXPECTED_SUMMARY, observed, cause, evidence) if cause else None
    if any(summary.messages % EVERY > 1 for summary in summaries):  # by another count than the true one, perhaps
        return None
    missing = [_diagnose_incomplete_summary(summary, fast) for summary in summaries[1:]]  # the first may be complete
    cause = missing[-1]
    if cause is None or {each and each.name for each in missing} != {cause.name}:
        return None
    return failed(EXPECTED_SUMMARY, f"it is incomplete {summaries[-1]}", cause, evidence)


def _fast_summaries(fast: Trial) -> Sequence[Summary]:
    """The summaries of a fast stretch; none where they may be few, late or torn because the messages came fast.

    Nor where two subscriptions may log one message twice: what that leads to shows best when messages come slowly.
    """
    summaries = find_summaries(fast)
    whole = len(fast.sent) >= FAST_MESSAGES and backlog.fast_enough(fast) and len(summaries) >= len(fast.sent) // EVERY
    prompt = fast.spins and fast.allowance_s < STALL_S and not backlog.messages_behind(fast)
    alone = sum(each.topic == TOPIC for each in fast.trace.graph.subscriptions) == 1
    return summaries if whole and prompt and alone else ()


def _diagnose_interval(summaries: Sequence[Summary], trial: Trial, messages: int) -> Cause | None:
    due = range(EVERY, messages + 1, EVERY)
    when = [summary.messages for summary in summaries]
    if len(summaries) > 3 and len(summaries) >= 0.7 * messages:
        return Cause(
            "summary for every message", f"{len(summaries)} summaries for {messages} messages", _every_ten(trial)
        )
    if len(summaries) > len(due) or any(summary.times > 1 for summary in summaries):
        return Cause(
            "too many summaries",
            f"{sum(summary.times for summary in summaries)} summaries for {messages} messages",
            _every_ten(trial),
        )
    for number in due:
        of_it = [each for each in summaries if milestone(each.messages) == number]
        if not any(in_time(each, trial) for each in of_it):
            early = [each for each in when if number - EVERY < each < number]
            late = [each for each in when if number < each < number + EVERY]
            said = f"it comes after {(early or late)[-1]}" if early or late else "and none comes later"
            return Cause("missing summary", f"there is none after {number} messages, {said}", _every_ten(trial))
    return None


def _every_ten(trial: Trial) -> str:
    """The step to one summary for every ten messages."""
    return steps.summarise_every_ten(trial.trace) or (
        f"if self.total_count % {EVERY} == 0: write the summary, in the callback, after counting"
    )


def _counts_wrongly(summaries: Sequence[Summary], trial: Trial) -> bool:
    """Whether each summary comes when its own count says so, and that count is not true.

    By chance one may be true: in a node that counts one too many, the summary after 9 messages may come late, after the
    10th.
    """
    by_its_count = all(summary.states(EVERY * number) for number, summary in enumerate(summaries, start=1))
    return by_its_count and any(not true_total(summary, trial) for summary in summaries)


def _diagnose_incomplete_summary(summary: Summary, trial: Trial) -> Cause | None:
    first = trial.sent[0]
    recent = trial.sent[milestone(summary.messages) - 1 : summary.until]
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
    called = {(name, number) for line in summary.lines for name, number in labelled(line.text)}
    swapped = [("first", each.number) for each in recent if each.number != first.number]
    if ("last", first.number) in called and called.intersection(swapped) and ("first", first.number) not in called:
        return Cause(
            "first and last swapped",
            f"it calls “{first.content}” the last one, and the last one the first",
            steps.summarise_every_ten(trial.trace)
            or "put self.first_message after “first”, and the message that has just come after “last”",
        )
    return None


def diagnose_no_summary(trial: Trial) -> Cause:
    """Why the node logs no summary."""
    trace = trial.trace
    if trace.exit is not None or not trial.sent or not (trial.lines or trial.spins):
        return steps.keep_node_up(
            trace, causes.diagnose_nothing_received(trace, OURS, answers=trial.spins, stuck=trial.stuck)
        )
    printed = causes.diagnose_printed(
        trace,
        lambda text: bool(read(_as_log(text), 1).quoted),
        "what the node has to say",
        after=trial.ending.output if trial.ending else (),
    )
    if printed is not None:
        return printed
    return Cause(
        "no summary",
        "none of its log messages sums up the messages" if trial.lines else "no log message follows from a message",
        steps.summarise_every_ten(trace)
        or f"count in the callback; if self.total_count % {EVERY} == 0: self.get_logger().info(...) with the count, "
        "the rate, the first and the last message",
    )


def _as_log(text: str) -> LogRecord:
    return LogRecord(20, "", text, 0.0, 0.0)


def _logged(trial: Trial) -> list[str]:
    return [str(log) for log in trial.trace.logs[-6:]] or list(causes.output_tail(trial.trace))


def judge_shutdown(steady: Trial) -> Verdict:
    return ending.judge_ending(steady.trace, steady.ending)
