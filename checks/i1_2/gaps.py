"""I1.2: the verdict on jumps of N."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from checks.i1_2 import losses
from checks.i1_2.facts import TOPIC, TYPE, Trial
from checks.i1_2.faults import Fault, ended, wrong_log
from checks.i1_2.negative_losses import find_negative_loss
from checks.i1_2.rates import sent_hz
from checks.i1_2.reading import Line
from checks.i1_2.reports import is_before_jump, kinds_about_first_message, new_lines
from checks.i1_2.summaries import find_summaries
from tutor.judge.rates import TOLERANCE
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Level
from tutor.judge.verdict import Verdict, failed, passed, skipped, undecided
from tutor.judge.wording import output_tail

SETTLING_MESSAGES = 2
"""An alarm about a jump is logged before this many more messages have been sent."""


EXPECTED = "when N jumps, a log message or a gap count in the next summary says so; while N rises by one, none does"


def judge_gaps(
    jump: Trial, jump_twice: Trial, jump_after_zero: Trial, restart: Trial, steady: Trial, fast: Trial
) -> Verdict:
    """Judge `gaps`."""
    if find_summaries(steady) and losses.is_certain(steady, fast):
        return skipped(losses.SEE_COUNT)
    verdict = judge_rising(jump, jump_twice, steady)
    if not verdict.passed:
        return verdict
    failure = judge_jump_after_zero(jump_after_zero, steady, jump) or judge_fall(restart, jump, jump_twice, steady)
    return failure or verdict


def judge_rising(jump: Trial, jump_twice: Trial, steady: Trial) -> Verdict:
    """Judge `gaps` by the runs in which N rises, and jumps far from 0."""
    if not jump.sent or not jump_twice.sent or (not find_summaries(steady) and not steady.lines):
        return skipped("not judged, because the node logs nothing about the messages: see `summary`")
    verdict = judge_jumps(jump, steady, jump_twice)
    return judge_jumps(jump_twice, steady) if verdict.passed else verdict


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
    evidence = [line.text for line in after_zero.lines[:6]]
    return failed(EXPECTED, observed, _unnoticed(after_zero, steady, {"fault": "0-taken-for-no-number"}), evidence)


def judge_fall(restart: Trial, jump: Trial, jump_twice: Trial, steady: Trial) -> Verdict | None:
    """Fail a node that states a negative number of missing messages when a new publisher starts over at 0."""
    if (line := find_negative_loss(restart, jump, jump_twice, steady)) is None:
        return None
    before, after = restart.sent[restart.before_break - 1 : restart.before_break + 1]
    return failed(
        f"{EXPECTED}; when N falls, no negative number of messages is missing",
        f"N fell from {before.number} to {after.number}: {line.text}",
        wrong_log(restart.trace, {"fault": "negative-number-of-missing-messages", "line_logged": line.text}),
        [line.text],
    )


def _fail_if_ended(trial: Trial) -> Verdict | None:
    if trial.trace.exit is None:
        return None
    words = output_tail(trial.trace)
    observed = f"the node ended after {len(trial.sent)} messages"
    return failed(EXPECTED, observed, ended(trial, "a jump of N"), words)


def judge_jumps(jump: Trial, steady: Trial, jump_twice: Trial | None = None) -> Verdict:
    """Judge `gaps` by one run in which N jumps.

    `jump_twice`: another one, in which it jumps again where it rises by one in the first: with it, a count of lost
    messages that keeps rising is told from a count of messages since the last jump.
    """
    expected = EXPECTED
    if (over := _fail_if_ended(jump)) is not None:
        return over
    reports = new_lines(jump, since=jump.sent[jump.before_break].at, usual=(steady,))
    jumped = [f"from {jump.sent[index - 1].number} to {jump.sent[index].number}" for index in jump.jumps]
    observed = f"N jumped {', and '.join(jumped)}"
    if reports and (again := _find_repeated_alarms(reports, jump)):
        texts = [line.text for line in again]
        what = f"it still says so when N rises by one again: {again[-1].text}"
        return failed(expected, observed, wrong_log(jump.trace, {"fault": "false-alarm", "what": what}), texts[:6])
    if jump_twice is not None and (rising := _find_rising_count(jump, jump_twice, steady)) is not None:
        return failed(expected, observed, wrong_log(jump.trace, rising[0]), rising[1])
    unused = list(reports)
    for index, how in zip(jump.jumps, jumped, strict=True):
        own = next((line for line in unused if _is_about_jump(line, index, jump)), None)
        if own is not None:
            unused.remove(own)
        elif not any(_is_about_jump(line, index, jump) and _reports_all_jumps(line, jump) for line in reports):
            alarms = _find_false_alarms(index, jump, steady)
            if alarms and all(trial.was_hurried(line.messages) for trial, line in alarms):
                return undecided("to tell whether the node lost messages")
            since = [line.text for line in jump.lines if line.messages > index]
            why = _see_no_warning(index, jump, steady, [line for _, line in alarms])
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


def _find_rising_count(jump: Trial, jump_twice: Trial, steady: Trial) -> tuple[Fault, list[str]] | None:
    """Find a number that rises at the jump and keeps rising afterwards; also return the lines that show it.

    It must have been constant before, and not be lower if N jumps twice, unlike a count of messages since the last
    jump. A timer may report a jump late, so only a number that has already risen is considered.
    """
    between = jump_twice.before_second_jump - jump_twice.before_break
    for kind in {line.kind for line in jump.lines if line.messages >= jump.before_break + SETTLING_MESSAGES}:
        lines = [line for line in jump.lines if line.kind == kind]
        starts = [
            [line for line in trial.lines if line.kind == kind and is_before_jump(line, trial)]
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
                what = (
                    f"the loss that it reports keeps rising while N rises by one again: {since[0].numbers[place].text} "
                    f"after {since[0].messages} messages, {since[-1].numbers[place].text} after {since[-1].messages}"
                )
                return {"fault": "false-alarm", "what": what}, texts
    return None


def _are_rates(values: Iterable[float], trial: Trial) -> bool:
    """Whether the values are the rate at which the messages were sent, within the tolerance."""
    hz = sent_hz(trial)
    return all(abs(value - hz) <= TOLERANCE * hz for value in values)


def _find_false_alarms(index: int, jump: Trial, steady: Trial) -> list[tuple[Trial, Line]]:
    """Lines of a kind that came with the jump to the message with this index, where N rises by one.

    They are alarms only if they came with some, but not with most messages.
    """
    in_summaries = {line.kind for summary in (*find_summaries(steady), *find_summaries(jump)) for line in summary.lines}
    with_it = range(index + 1, index + 3)
    since = {line.kind for line in jump.lines if line.messages in with_it} - in_summaries
    calm = [(trial, line) for trial in (steady, jump) for line in trial.lines if is_before_jump(line, trial)]
    found = [(trial, line) for trial, line in calm if line.kind in since]
    return found if len(found) < 0.7 * (len(steady.sent) + jump.before_break - 2) else []


def _see_no_warning(index: int, jump: Trial, steady: Trial, false: Sequence[Line]) -> Observation:
    """The jump to the message with this index is not reported; `false`: the false alarms (`_find_false_alarms`)."""
    if false:
        what = f"it also says so where N rises by one: {false[0].text}"
        return wrong_log(jump.trace, {"fault": "false-alarm", "what": what})
    words = ("gap", "miss", "lost", "skip", "lücke", "jump")
    after = [line for line in jump.trace.output if line.at >= jump.sent[index].at and line.stream == "stdout"]
    printed = {line.text for line in after if any(word in line.text.casefold() for word in words)}
    missed = jump.missed(index)[-1]
    amount = f"{missed} number{'s are' if missed > 1 else ' is'} missing"
    return _unnoticed(jump, steady, {"fault": "gap-not-noticed", "missed": amount, "recognise": printed.__contains__})


def _unnoticed(jump: Trial, steady: Trial, fault: Fault) -> Observation:
    """A jump of N is in no log message; a node that does not spin has shown so in one of the two trials."""
    asked = jump if steady.spins else steady
    return Symptom.NOT_LOGGED.seen(
        jump.trace,
        stuck=asked.stuck,
        answers=asked.spins,
        topic=TOPIC,
        type=TYPE,
        what="the gap",
        no_message=True,
        **fault,
    )
