"""I1.2: the verdicts on jumps of N, and on a publisher that is replaced by a new one that starts over."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from itertools import accumulate

from checks.i1_2 import gap_steps, steps
from checks.i1_2.facts import OURS, SOON_S, SUMMARY_EVERY, Trial
from checks.i1_2.judges import NO_SUMMARY, judge_slow_summary
from checks.i1_2.rates import sent_hz
from checks.i1_2.reading import Line
from checks.i1_2.summaries import Summary, find_summaries, last_due_count
from checks.i1_2.totals import counts_truly, true_total
from tutor.judge import causes
from tutor.judge.causes import printing
from tutor.judge.rates import TOLERANCE
from tutor.judge.trace import Level
from tutor.judge.verdict import Cause, Verdict, failed, passed, skipped

SETTLING_MESSAGES = 2
"""An alarm about a jump is logged before this many more messages have been sent."""


def judge_restart(restart: Trial, steady: Trial, jump: Trial) -> Verdict:
    """Judge `restart`."""
    expected = "the publisher goes away, a new one starts over at 0: the node lives on and keeps counting"
    if not find_summaries(steady):
        return skipped(NO_SUMMARY)
    words = causes.output_tail(restart.trace)
    sent, before = len(restart.sent), restart.before_break
    if restart.trace.exit is not None:
        return failed(
            expected, f"the node ended after {sent} of our messages", _diagnose_end(restart, "another publisher"), words
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


def judge_gaps(jump: Trial, jump_twice: Trial, steady: Trial) -> Verdict:
    """Judge `gaps`."""
    if not jump.sent or not jump_twice.sent or (not find_summaries(steady) and not steady.lines):
        return skipped("not judged, because the node logs nothing about the messages: see `summary`")
    verdict = judge_jumps(jump, steady, jump_twice)
    return judge_jumps(jump_twice, steady) if verdict.passed else verdict


def judge_jumps(jump: Trial, steady: Trial, jump_twice: Trial | None = None) -> Verdict:
    """Judge `gaps` by one run in which N jumps.

    `jump_twice`: another one, in which it jumps again where it rises by one in the first: with it, a count of lost
    messages that keeps rising is told from a count of messages since the last jump.
    """
    expected = "when N jumps, a log message or a gap count in the next summary says so; while N rises by one, none does"
    if jump.trace.exit is not None:
        words = causes.output_tail(jump.trace)
        return failed(
            expected, f"the node ended after {len(jump.sent)} messages", _diagnose_end(jump, "a jump of N"), words
        )
    reports = new_lines(jump, since=jump.sent[jump.before_break].at, usual=(steady,))
    jumped = [f"from {jump.sent[index - 1].number} to {jump.sent[index].number}" for index in jump.jumps]
    observed = f"N jumped {', and '.join(jumped)}"
    if reports and (again := _find_repeated_alarms(reports, jump)):
        texts = [line.text for line in again]
        cause = gap_steps.diagnose_alarm(jump.trace, texts) or Cause(
            "false alarm",
            f"it still says so when N rises by one again: {again[-1].text}",
            steps.compare_numbers(jump.trace, texts) or gap_steps.COMPARE,
        )
        return failed(expected, observed, cause, texts[:6])
    if jump_twice is not None and (rising := _diagnose_rising_count(jump, jump_twice, steady)) is not None:
        return failed(expected, observed, *rising)
    unused = list(reports)
    for index, how in zip(jump.jumps, jumped, strict=True):
        own = next((line for line in unused if _is_about_jump(line, index, jump)), None)
        if own is not None:
            unused.remove(own)
        elif not any(_is_about_jump(line, index, jump) and _reports_all_jumps(line, jump) for line in reports):
            since = [line.text for line in jump.lines if line.messages > index]
            why = _diagnose_no_warning(index, jump, steady)
            return failed(expected, f"N jumped {how}; nothing new was logged", why, since[:6])
    return passed(expected, observed, [line.text for line in reports[:3]])


def _is_about_jump(line: Line, index: int, jump: Trial) -> bool:
    """Whether the line was logged after this jump and before the next one, allowing for delays by the machine."""
    later = [jump.sent[after].at for after in jump.jumps if after > index]
    return line.at >= jump.sent[index].at and all(line.at < at + jump.allowance_s for at in later)


def _reports_all_jumps(line: Line, jump: Trial) -> bool:
    """Whether the line reports all jumps so far: their number, or the total of missed messages."""
    missed = jump.missed(line.messages)
    return len(missed) > 1 and any(each.value in (len(missed), sum(missed)) for each in line.numbers)


def _find_repeated_alarms(reports: Sequence[Line], jump: Trial) -> list[Line]:
    """The alarms that are repeated for most messages after the jump: warnings, or growing counts of missed messages."""
    later = [line for line in reports if line.messages > jump.before_break + SETTLING_MESSAGES]
    expected = jump.sent[jump.before_break - 1].number + 1
    growing = [
        line
        for line in later
        if any(number.value == jump.sent[line.messages - 1].number - expected for number in line.numbers)
    ]
    for alarms in (growing, [line for line in later if line.level >= Level.WARN]):
        if len({line.messages for line in alarms}) > 0.7 * (len(jump.sent) - jump.before_break - SETTLING_MESSAGES):
            return alarms
    return []


def _diagnose_rising_count(jump: Trial, jump_twice: Trial, steady: Trial) -> tuple[Cause, list[str]] | None:
    """Find a number that rises at the jump and keeps rising afterwards; also return the lines that show it.

    It must have been constant before, and not be lower if N jumps twice, unlike a count of messages since the last
    jump. A timer may report a jump late, so only a number that has already risen is considered.
    """
    between = jump_twice.before_second_jump - jump_twice.before_break
    for kind in {line.kind for line in jump.lines if line.messages >= jump.before_break + SETTLING_MESSAGES}:
        lines = [line for line in jump.lines if line.kind == kind]
        starts = [
            [line for line in trial.lines if line.kind == kind and _is_before_jump(line, trial)]
            for trial in (jump, steady)
        ]
        usual = [line for lines in starts for line in lines]
        twice = [line for line in jump_twice.lines if line.kind == kind]
        amount = {len(line.numbers) for line in (*lines, *usual, *twice)}
        if max(map(len, starts)) < 2 or len(amount) > 1:  # a single line does not show what is constant
            continue
        since = [line for line in lines if line.messages >= jump.before_break + SETTLING_MESSAGES]
        again = [line for line in twice if line.messages > jump_twice.before_second_jump]
        for place in range(*amount):
            values_before = {line.numbers[place].value for line in usual}
            rose = [line.numbers[place].value for line in since]
            ends = [line.numbers[place].value for line in again[-1:]]
            whole = all(value.is_integer() for value in rose)
            is_rate = _are_rates(values_before, steady) and _are_rates(rose, jump)  # over the last second, say
            if (
                len(values_before) == 1
                and whole
                and not is_rate
                and max(values_before) < rose[0] < rose[-1] < min(ends, default=rose[-1]) + between / 2
            ):
                texts = [line.text for line in (since[0], since[-1])]
                return gap_steps.diagnose_alarm(jump.trace, texts) or Cause(
                    "false alarm",
                    f"the loss that it reports keeps rising while N rises by one again: {since[0].numbers[place].text} "
                    f"after {since[0].messages} messages, {since[-1].numbers[place].text} after {since[-1].messages}",
                    steps.compare_numbers(jump.trace, texts) or gap_steps.COMPARE,
                ), texts
    return None


def _are_rates(values: Iterable[float], trial: Trial) -> bool:
    """Whether the values are the rate at which the messages were sent, within the tolerance."""
    hz = sent_hz(trial)
    return all(abs(value - hz) <= TOLERANCE * hz for value in values)


def _diagnose_end(trial: Trial, what: str) -> Cause:
    ended = Cause("exit at once", f"the node does not survive {what}", "keep it running")
    return steps.keep_node_up(trial.trace, causes.diagnose_process(trial.trace) or ended)


def _diagnose_no_warning(index: int, jump: Trial, steady: Trial) -> Cause:
    """Why the jump to the message with this index is not reported.

    A kind of line that came with the jump, and also with some, but not all, other messages, was a false alarm there.
    """
    in_summaries = {line.kind for summary in (*find_summaries(steady), *find_summaries(jump)) for line in summary.lines}
    with_it = range(index + 1, index + 3)
    since = {line.kind for line in jump.lines if line.messages in with_it} - in_summaries
    calm = [line for trial in (steady, jump) for line in trial.lines if _is_before_jump(line, trial)]
    false = [line for line in calm if line.kind in since]
    if 0 < len(false) < 0.7 * (len(steady.sent) + jump.before_break - 2):
        texts = [line.text for line in false]
        return gap_steps.diagnose_alarm(jump.trace, texts) or Cause(
            "false alarm",
            f"it also says so where N rises by one: {false[0].text}",
            steps.compare_numbers(jump.trace, texts)
            or "compare numbers, not texts: int(msg.data.split(':')[1]) must be the last number + 1",
        )
    words = ("gap", "miss", "lost", "skip", "lücke", "jump")
    after = [line for line in jump.trace.output if line.at >= jump.sent[index].at and line.stream == "stdout"]
    printed = next((line.text for line in after if any(word in line.text.casefold() for word in words)), None)
    if printed is not None:
        call = printing.find_print(jump.trace, printed)
        step = printing.log_instead_of_print(jump.trace, call) if call else steps.compare_numbers(jump.trace)
        return Cause("printed, not logged", f"it is only printed: {printed}", step or "self.get_logger().warning(...)")
    missed = jump.missed(index)[-1]
    return gap_steps.diagnose_no_messages(jump.trace) or Cause(
        "gap not noticed",
        f"{missed} number{'s are' if missed > 1 else ' is'} missing, "
        "and nothing distinguishes this from any other message",
        steps.compare_numbers(jump.trace)
        or "keep the last N; where the next one is not that + 1, self.get_logger().warning(...) how many are missing",
    )


def new_lines(trial: Trial, *, since: float, usual: Sequence[Trial]) -> list[Line]:
    """The lines from `since` on that the node does not log while N rises by one.

    These are lines of a new kind, or with a change in a number that was constant before. `usual`: other trials, used up
    to their own jump. Lines logged with a first message are not alarms, and do not define usual kinds.
    """
    before = [line for line in trial.lines if line.at < since and not _is_about_first_message(line, trial)]
    elsewhere = [[line for line in other.lines if _is_before_jump(line, other)] for other in usual]
    known = {line.kind for lines in (before, *elsewhere) for line in lines}
    in_summaries = {line: summary for summary in find_summaries(trial) for line in summary.lines}
    reports = []
    for line in trial.lines:
        if line.at < since:
            continue
        same_kind = [other for other in before if other.kind == line.kind]
        others = [found for lines in elsewhere if (found := [other for other in lines if other.kind == line.kind])]
        if line.kind not in known or _reports_jump(line, in_summaries.get(line), same_kind, others, trial):
            reports.append(line)
    return reports


def _is_before_jump(line: Line, trial: Trial) -> bool:
    return not _is_about_first_message(line, trial) and not (trial.before_break and line.messages > trial.before_break)


def _is_about_first_message(line: Line, trial: Trial) -> bool:
    return line.at < trial.sent[0].at + SOON_S


def _reports_jump(
    line: Line, summary: Summary | None, before: Sequence[Line], elsewhere: Sequence[Sequence[Line]], trial: Trial
) -> bool:
    """Whether a number in the line reports the jump: as a count of gaps, of missed or of expected messages.

    `summary`: the summary that contains the line, if any.
    """
    others = [other for lines in (before, *elsewhere) for other in lines]
    missed = trial.missed(line.messages)
    if not others or any(len(other.numbers) != len(line.numbers) for other in others):
        return False
    for place, number in enumerate(line.numbers):
        values_before = {other.numbers[place].value for other in before or others}
        usual_values = [{other.numbers[place].value for other in lines} for lines in elsewhere]
        if summary is not None and _includes_missed(place, line, summary, others, missed):
            return True
        if len(values_before) > 1 or any(len(each) > 1 for each in usual_values):
            continue
        base = values_before.pop()
        increase = number.value - base
        from_zero = any(each == {0.0} for each in usual_values)
        if summary is None:
            # In a line that is logged with every message, a number is a report if it was 0 before, and no warning.
            is_report = base == 0 and from_zero and line.level < Level.WARN and _is_count_of_jump(increase, missed)
        else:
            is_report = from_zero and (_is_count_of_jump(increase, missed) or _is_loss_share(increase, missed, trial))
            is_report = is_report or (
                all(each == {base} for each in usual_values) and _reflects_jump(increase, base, missed, trial)
            )
        if is_report:
            return True
    return False


def _includes_missed(place: int, line: Line, summary: Summary, calm: Iterable[Line], missed: Sequence[int]) -> bool:
    """Whether a number that equalled the count now also includes missed messages, beside the count itself."""
    due = last_due_count(line.messages)
    followed = all(other.numbers[place].value == last_due_count(other.messages) > 0 for other in calm)
    greater = line.numbers[place].value - due in [each for each in _missed_totals(missed) if each > 0]
    return followed and greater and summary.states(due)


def _missed_totals(missed: Sequence[int]) -> set[int]:
    """The messages missed by each single jump, and the running totals."""
    return {*missed, *accumulate(missed)}


def _is_count_of_jump(increase: float, missed: Sequence[int]) -> bool:
    """Whether the increase is the number of jumps, or of missed messages."""
    return increase in range(1, len(missed) + 1) or _is_count_of_missed(increase, missed)


def _is_count_of_missed(increase: float, missed: Sequence[int]) -> bool:
    """Whether the increase is the number of missed messages, or the step of N."""
    return any(
        increase in (abs(amount), abs(amount) + 1, abs(amount) + len(missed)) for amount in _missed_totals(missed)
    )


def _reflects_jump(increase: float, base: float, missed: Sequence[int], trial: Trial) -> bool:
    """Whether a number that was `base` reflects the jump: as a run number, missed messages or the share received."""
    if increase == 1 and any(each < 0 for each in missed):
        return True
    delivered = base in (1, 100) and _is_loss_share(-increase, missed, trial, scales=(base,))
    return _is_count_of_missed(increase, missed) or delivered


def _is_loss_share(increase: float, missed: Sequence[int], trial: Trial, *, scales: Sequence[float] = (1, 100)) -> bool:
    """Whether the increase is the share of lost messages or of jumps, as a fraction or in percent, to two digits."""
    if any(each < 0 for each in missed) or increase <= 0:
        return False
    jumps = range(1, len(missed) + 1)
    shares = {
        lost / (whole + more)
        for lost in (*jumps, *_missed_totals(missed))
        for whole in range(trial.before_break + 1, len(trial.sent) + 1)
        for more in (0, *_missed_totals(missed), *(-each for each in jumps))
    }
    return any(abs(increase - scale * share) <= 0.0051 * scale for share in shares for scale in scales)
