"""I1.2: the verdict on `gaps`: a jump of N is reported, and nothing else is."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from checks.i1_2_message_statistics.count import Fault, fails, unless_messages_are_lost
from checks.i1_2_message_statistics.jump_reports import is_before_jump, kinds_about_first_message, new_lines
from checks.i1_2_message_statistics.log_lines import Line
from checks.i1_2_message_statistics.logged_summaries import find_summaries
from checks.i1_2_message_statistics.negative_losses import find_negative_loss
from checks.i1_2_message_statistics.rate import sent_hz
from checks.i1_2_message_statistics.trial import SHOWN, Trial
from tutor.judge.rates import TOLERANCE
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Level
from tutor.judge.verdict import Verdict, failed, passed, skipped, undecided
from tutor.judge.wording import output_tail

EXPECTED = "when N jumps, a log message or a gap count in the next summary says so; while N rises by one, none does"

SETTLING_MESSAGES = 2
"""An alarm about a jump is logged before this many more messages have been sent."""

MOST = 0.7
"""Lines that come with at least this share of messages are about every message."""


@unless_messages_are_lost
def judge_gaps(
    steady: Trial, jump: Trial, jump_twice: Trial, jump_after_zero: Trial, restart: Trial, fast: Trial
) -> Verdict:
    """Judge `gaps`."""
    if not jump.sent or not jump_twice.sent or (not find_summaries(steady) and not steady.lines):
        return skipped("not judged, because the node logs nothing about the messages: see `summary`")
    verdict = judge_jumps(jump, steady, jump_twice)
    if not verdict.passed:
        return verdict
    again = judge_jumps(jump_twice, steady)
    if not again.passed:
        return again
    failure = judge_jump_after_zero(jump_after_zero, steady, jump) or judge_fall(restart, jump, jump_twice, steady)
    return failure or again


def judge_jumps(jump: Trial, steady: Trial, jump_twice: Trial | None = None) -> Verdict:
    """Judge `gaps` by one run in which N jumps.

    `jump_twice`: another one, in which it jumps again where it rises by one in the first: with it, a count of lost
    messages that keeps rising is told from a count of messages since the last jump.
    """
    if (over := _fail_if_ended(jump)) is not None:
        return over
    reports = new_lines(jump, since=jump.sent[jump.before_break].at, usual=(steady,))
    jumped = [f"from {jump.sent[index - 1].number} to {jump.sent[index].number}" for index in jump.jumps]
    observed = f"N jumped {', and '.join(jumped)}"
    if reports and (repeated := _find_repeated_alarms(reports, jump)):
        what = f"it still says so when N rises by one again: {repeated[-1].text}"
        return _false_alarm(what, observed, jump, repeated)
    if jump_twice is not None and (rising := _find_rising_count(jump, jump_twice, steady)):
        (first, count), (last, more) = rising
        what = (
            f"the loss that it reports keeps rising while N rises by one again: {count} after {first.messages} "
            f"messages, {more} after {last.messages}"
        )
        return _false_alarm(what, observed, jump, (first, last))
    unused = list(reports)
    for index, how in zip(jump.jumps, jumped, strict=True):
        own = next((line for line in unused if _is_about_jump(line, index, jump)), None)
        if own is not None:
            unused.remove(own)
        elif not any(_is_about_jump(line, index, jump) and _reports_all_jumps(line, jump) for line in reports):
            alarms = _find_false_alarms(index, jump, steady)
            if alarms and all(trial.was_hurried(line.messages) for trial, line in alarms):
                return undecided("to tell whether the node lost messages")
            since = [line for line in jump.lines if line.messages > index]
            observed = f"N jumped {how}; nothing new was logged"
            if alarms:
                what = f"it also says so where N rises by one: {alarms[0][1].text}"
                return _false_alarm(what, observed, jump, since)
            return failed(EXPECTED, observed, _see_no_warning(index, jump, steady), _texts(since))
    return passed(EXPECTED, observed, _texts(reports[:3]))


def judge_jump_after_zero(after_zero: Trial, steady: Trial, jump: Trial) -> Verdict | None:
    """Fail a node that reports other jumps, but not one from 0."""
    if (over := _fail_if_ended(after_zero)) is not None:
        return over
    if not after_zero.jumps:
        return None
    # What is said about a first message may be late, and that one is 0 in the steady run, too.
    usual_kinds = kinds_about_first_message(steady)
    if new_lines(after_zero, since=after_zero.sent[1].at, usual=(steady, jump), usual_kinds=usual_kinds):
        return None
    observed = f"N jumped from 0 to {after_zero.sent[1].number}; nothing new was logged"
    unnoticed = _see_unnoticed(after_zero, steady, fault="0-taken-for-no-number")
    return failed(EXPECTED, observed, unnoticed, _texts(after_zero.lines))


def judge_fall(restart: Trial, jump: Trial, jump_twice: Trial, steady: Trial) -> Verdict | None:
    """Fail a node that states a negative number of missing messages when a new publisher starts over at 0."""
    if (line := find_negative_loss(restart, jump, jump_twice, steady)) is None:
        return None
    before, after = restart.sent[restart.before_break - 1 : restart.before_break + 1]
    return fails(
        f"{EXPECTED}; when N falls, no negative number of messages is missing",
        f"N fell from {before.number} to {after.number}: {line.text}",
        restart,
        {"fault": "negative-number-of-missing-messages", "line_logged": line.text},
        [line.text],
    )


def _fail_if_ended(trial: Trial) -> Verdict | None:
    if trial.trace.exit is None:
        return None
    observed = f"the node ended after {len(trial.sent)} messages"
    return failed(EXPECTED, observed, trial.ended("a jump of N"), output_tail(trial.trace))


def _false_alarm(what: str, observed: str, jump: Trial, lines: Iterable[Line]) -> Verdict:
    fault: Fault = {"fault": "false-alarm", "what": what}
    return fails(EXPECTED, observed, jump, fault, _texts(lines))


def _texts(lines: Iterable[Line]) -> list[str]:
    """The texts of some lines, enough to show what they are about."""
    return [line.text for line in lines][:SHOWN]


def _is_about_jump(line: Line, index: int, jump: Trial) -> bool:
    """Whether the line was logged after this jump and before the next one, allowing for delays by the machine."""
    later = [jump.sent[after].at for after in jump.jumps if after > index]
    return line.at >= jump.sent[index].at and all(line.at < at + jump.allowance_s for at in later)


def _reports_all_jumps(line: Line, jump: Trial) -> bool:
    """Whether the line reports all jumps so far: their number, or the total of missed messages."""
    missed = jump.missed(line.messages)
    return len(missed) > 1 and any(number.value in (len(missed), sum(missed)) for number in line.numbers)


def _find_repeated_alarms(reports: Sequence[Line], jump: Trial) -> list[Line]:
    """The alarms that are repeated for most messages after the jump: warnings, or growing counts of missed messages."""
    settled = jump.before_break + SETTLING_MESSAGES
    later = [line for line in reports if line.messages > settled]
    expected = jump.sent[jump.before_break - 1].number + 1

    def is_growing(line: Line) -> bool:
        missing = jump.sent[line.messages - 1].number - expected
        return any(number.value == missing for number in line.numbers)

    for alarms in (list(filter(is_growing, later)), [line for line in later if line.level >= Level.WARN]):
        if len({line.messages for line in alarms}) > MOST * (len(jump.sent) - settled):
            return alarms
    return []


def _find_rising_count(jump: Trial, jump_twice: Trial, steady: Trial) -> list[tuple[Line, str]]:
    """Find a number that rises at the jump and keeps rising afterwards; return two lines that show it, with the number.

    It must have been constant before, and not be lower if N jumps twice, unlike a count of messages since the last
    jump. A timer may report a jump late, so only a number that has already risen is considered.
    """
    settled, second_jump = jump.before_break + SETTLING_MESSAGES, max(jump_twice.jumps, default=0)
    for kind in {line.kind for line in jump.lines if line.messages >= settled}:
        lines, twice, calm = (
            [line for line in trial.lines if line.kind == kind] for trial in (jump, jump_twice, steady)
        )
        starts = [[line for line in of if is_before_jump(line, trial)] for of, trial in ((lines, jump), (calm, steady))]
        usual = [line for start in starts for line in start]
        amount = {len(line.numbers) for line in (*lines, *usual, *twice)}
        if max(map(len, starts)) < 2 or len(amount) > 1:  # a single line does not show what is constant
            continue
        since = [line for line in lines if line.messages >= settled]
        again = [line for line in twice if line.messages > second_jump]
        between = second_jump - jump_twice.before_break
        for place in range(*amount):
            before = {line.numbers[place].value for line in usual}
            rose = [line.numbers[place].value for line in since]
            end = again[-1].numbers[place].value if again else rose[-1]
            is_rate = _are_rates(before, steady) and _are_rates(rose, jump)  # over the last second, say
            whole = all(value.is_integer() for value in rose)
            if len(before) == 1 and whole and not is_rate and max(before) < rose[0] < rose[-1] < end + between / 2:
                return [(line, line.numbers[place].text) for line in (since[0], since[-1])]
    return []


def _are_rates(values: Iterable[float], trial: Trial) -> bool:
    """Whether the values are the rate at which the messages were sent, within the tolerance."""
    hz = sent_hz(trial)
    return all(abs(value - hz) <= TOLERANCE * hz for value in values)


def _find_false_alarms(index: int, jump: Trial, steady: Trial) -> list[tuple[Trial, Line]]:
    """Lines of a kind that came with the jump to the message with this index, where N rises by one.

    They are alarms only if they came with some, but not with most messages.
    """
    in_summaries = {
        line.kind for trial in (steady, jump) for summary in find_summaries(trial) for line in summary.lines
    }
    with_it = range(index + 1, index + 3)
    since = {line.kind for line in jump.lines if line.messages in with_it} - in_summaries
    calm = [(trial, line) for trial in (steady, jump) for line in trial.lines if is_before_jump(line, trial)]
    found = [(trial, line) for trial, line in calm if line.kind in since]
    return found if len(found) < MOST * (len(steady.sent) + jump.before_break - 2) else []


def _see_no_warning(index: int, jump: Trial, steady: Trial) -> Observation:
    """The jump to the message with this index is not reported."""
    words = ("gap", "miss", "lost", "skip", "lücke", "jump")
    after = [line for line in jump.trace.output if line.at >= jump.sent[index].at and line.stream == "stdout"]
    printed = {line.text for line in after if any(word in line.text.casefold() for word in words)}
    missed = jump.missed(index)[-1]
    amount = f"{missed} number{'s are' if missed > 1 else ' is'} missing"
    return _see_unnoticed(jump, steady, fault="gap-not-noticed", missed=amount, recognise=printed.__contains__)


def _see_unnoticed(jump: Trial, steady: Trial, **fault: object) -> Observation:
    """A jump of N is in no log message; a node that does not spin has shown so in one of the two trials."""
    asked = jump if steady.spins else steady
    return jump.seen(
        Symptom.NOT_LOGGED, stuck=asked.stuck, answers=asked.spins, what="the gap", no_message=True, **fault
    )
