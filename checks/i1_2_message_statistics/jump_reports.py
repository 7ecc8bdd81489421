"""I1.2: the lines with which a node reports a jump of N, told from those that it logs while N rises by one."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from itertools import accumulate

from checks.i1_2_message_statistics.log_lines import Line
from checks.i1_2_message_statistics.logged_summaries import Summary, find_summaries, last_due_count
from checks.i1_2_message_statistics.trial import SOON_S, Trial
from tutor.judge.trace import Level
from tutor.judge.wording import shape

Kinds = frozenset[tuple[int, str]]


def new_lines(trial: Trial, *, since: float, usual: Sequence[Trial], usual_kinds: Kinds = frozenset()) -> list[Line]:
    """The lines from `since` on that the node does not log while N rises by one.

    These are lines of a new kind, or with a change in a number that was constant before. `usual`: other trials, used up
    to their own jump. Lines logged with a first message are not alarms, and do not define usual kinds, except those of
    `usual_kinds`.
    """
    before = [line for line in trial.lines if line.at < since and not _is_about_first_message(line, trial)]
    elsewhere = [[line for line in other.lines if is_before_jump(line, other)] for other in usual]
    calm = [line for lines in (before, *elsewhere) for line in lines]
    known = {line.kind for line in calm} | usual_kinds
    warnings = {_with_short_lists(line) for line in calm if line.level >= Level.WARN}
    in_summaries = {line: summary for summary in find_summaries(trial) for line in summary.lines}

    def is_report(line: Line) -> bool:
        is_longer = line.level >= Level.WARN and _with_short_lists(line) in warnings
        if line.kind not in known and not is_longer:
            return True
        same_kind, *others = ([other for other in lines if other.kind == line.kind] for lines in (before, *elsewhere))
        return _has_new_number(line, in_summaries.get(line), same_kind, [lines for lines in others if lines], trial)

    return [line for line in trial.lines if line.at >= since and is_report(line)]


def _with_short_lists(line: Line) -> str:
    """The line's shape, with one number for each list of numbers.

    A node that warns about each message, with a list of numbers, does not report a jump by a longer list.
    """
    return re.sub(r"#(?:, ?#)+", "#", shape(line.text))


def kinds_about_first_message(trial: Trial) -> Kinds:
    """The kinds of lines that may be about a first message."""
    return frozenset(line.kind for line in trial.lines if _is_about_first_message(line, trial))


def is_before_jump(line: Line, trial: Trial) -> bool:
    """Whether the line was logged before N first jumped, and is not about the first message."""
    return not _is_about_first_message(line, trial) and not (trial.jumps and line.messages > trial.jumps[0])


def _is_about_first_message(line: Line, trial: Trial) -> bool:
    return line.at < trial.sent[0].at + SOON_S


def _has_new_number(
    line: Line, summary: Summary | None, before: Sequence[Line], elsewhere: Sequence[Sequence[Line]], trial: Trial
) -> bool:
    """Whether a number in the line reports the jump: as a count of gaps, of missed or of expected messages.

    `summary`: the summary that contains the line, if any. `before`, `elsewhere`: calm lines of the same kind.
    """
    others = [other for lines in (before, *elsewhere) for other in lines]
    missed = trial.missed(line.messages)
    if not others or any(len(other.numbers) != len(line.numbers) for other in others):
        return False
    for place, number in enumerate(line.numbers):
        if summary is not None and _includes_missed(place, line, summary, others, missed):
            return True
        values_before = {other.numbers[place].value for other in before or others}
        usual_values = [{other.numbers[place].value for other in lines} for lines in elsewhere]
        if any(len(values) > 1 for values in (values_before, *usual_values)):
            continue
        (base,) = values_before
        increase = number.value - base
        from_zero = {0.0} in usual_values
        if summary is None:
            # In a line that is logged with every message, a number is a report if it was 0 before, and no warning.
            is_report = base == 0 and from_zero and line.level < Level.WARN and _is_count_of_jump(increase, missed)
        elif from_zero and (_is_count_of_jump(increase, missed) or _is_loss_share(increase, missed, trial)):
            is_report = True
        else:
            is_report = all(values == {base} for values in usual_values) and _reflects_jump(
                increase, base, missed, trial
            )
        if is_report:
            return True
    return False


def _includes_missed(place: int, line: Line, summary: Summary, calm: Iterable[Line], missed: Sequence[int]) -> bool:
    """Whether a number that equalled the count now also includes missed messages, beside the count itself."""
    due = last_due_count(line.messages)
    followed = all(other.numbers[place].value == last_due_count(other.messages) > 0 for other in calm)
    greater = line.numbers[place].value - due in [total for total in _missed_totals(missed) if total > 0]
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
    if increase == 1 and any(amount < 0 for amount in missed):
        return True
    delivered = base in (1, 100) and _is_loss_share(-increase, missed, trial, scales=(base,))
    return _is_count_of_missed(increase, missed) or delivered


def _is_loss_share(increase: float, missed: Sequence[int], trial: Trial, *, scales: Sequence[float] = (1, 100)) -> bool:
    """Whether the increase is the share of lost messages or of jumps, as a fraction or in percent, to two digits."""
    if any(amount < 0 for amount in missed) or increase <= 0:
        return False
    jumps, totals = range(1, len(missed) + 1), _missed_totals(missed)
    shares = {
        lost / (whole + more)
        for lost in (*jumps, *totals)
        for whole in range(trial.before_break + 1, len(trial.sent) + 1)
        for more in (0, *totals, *(-jump for jump in jumps))
    }
    return any(abs(increase - scale * share) <= 0.0051 * scale for share in shares for scale in scales)
