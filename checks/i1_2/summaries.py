"""I1.2: find the summaries among log messages by their content and timing, not by their wording."""

from __future__ import annotations

from collections import Counter
from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from checks.i1_2.facts import SOON_S, SUMMARY_EVERY, Trial
from checks.i1_2.reading import Line, Number

AT_ONCE_S = 0.05
"""Lines that are logged within this time of each other belong together."""

FREQUENT_SHARE = 0.5
"""A kind of line logged for at least this share of messages is no summary line, unless summaries are as frequent."""

MAX_AGE = 4
"""A summary's last message is at most this many messages old, or the one at which the summary was due."""


@dataclass(frozen=True)
class Summary:
    """A summary: lines that were logged together. `messages`: how many had been sent when the first line was logged."""

    lines: tuple[Line, ...]

    @property
    def at(self) -> float:
        return self.lines[0].at

    @property
    def messages(self) -> int:
        return self.lines[0].messages

    @property
    def messages_at_end(self) -> int:
        """How many messages had been sent when its last line was logged."""
        return self.lines[-1].messages

    @property
    def quoted(self) -> tuple[int, ...]:
        return tuple(number for line in self.lines for number in line.quoted)

    @property
    def numbers(self) -> tuple[Number, ...]:
        return tuple(number for line in self.lines for number in line.numbers)

    @property
    def kinds(self) -> frozenset[tuple[int, str]]:
        return frozenset(line.kind for line in self.lines if line.tells)

    @property
    def repetitions(self) -> int:
        """How often the summary was logged: the same lines, with the same quotations, may be repeated."""
        for length in range(1, len(self.lines) // 2 + 1):
            times, rest = divmod(len(self.lines), length)
            parts = [self.lines[start : start + length] for start in range(0, len(self.lines), length)]
            if rest or not (any(line.quoted for line in parts[0]) and any(line.numbers for line in parts[0])):
                continue
            if len({tuple((line.kind, line.quoted) for line in part) for part in parts}) == 1:
                return times
        return 1

    def states(self, value: float) -> bool:
        """Whether the summary contains this number, in any notation."""
        return any(value in number.values for number in self.numbers)

    def __str__(self) -> str:
        return f"after {self.messages} messages: " + " / ".join(line.text for line in self.lines)


def last_due_count(messages: int) -> int:
    """The number of messages after which a summary was last due."""
    return messages - messages % SUMMARY_EVERY


def is_in_time(summary: Summary, trial: Trial) -> bool:
    """Whether the summary was logged at the tenth, twentieth, ... message, or soon after."""
    due = last_due_count(summary.messages)
    return due > 0 and summary.at - trial.sent[due - 1].at <= trial.summary_limit_s


def possible_totals(summary: Summary, trial: Trial, *, before: int = 0) -> range:
    """The totals that the summary may truthfully state, if the first `before` messages do not count.

    It may have been composed a moment before it was logged, and be logged in several parts.
    """
    counted = summary.messages - before
    earliest = counted
    if last_due_count(counted) > 0 and (
        summary.at - trial.sent[before + last_due_count(counted) - 1].at <= trial.summary_limit_s
    ):
        earliest = last_due_count(counted)
    elif summary.at - trial.sent[summary.messages - 1].at <= AT_ONCE_S + trial.allowance_s:
        earliest = counted - 1
    return range(max(earliest, 1), summary.messages_at_end - before + 1)


def find_summaries(trial: Trial) -> tuple[Summary, ...]:
    """Find the summaries in the log, complete or not, oldest first."""
    times = Counter(line.kind for line in trial.lines)
    usual = {kind for kind, count in times.items() if count >= max(3, FREQUENT_SHARE * len(trial.sent))}
    special = group_lines([line for line in trial.lines if line.kind not in usual], trial)
    if complete := _without_break_reports([summary for summary in special if is_complete(summary, trial)], trial):
        return _without_coincidences(_with_similar(complete, special), special, trial)
    everything = group_lines(trial.lines, trial)
    complete = [summary for summary in everything if summary.messages > 1 and is_complete(summary, trial)]
    if len(complete) > len(trial.sent) / 4:
        return _without_coincidences(_with_similar(complete, everything), everything, trial)
    return _without_coincidences(_find_best_family(special, trial), special, trial)


def count_complete(trial: Trial) -> int:
    """The number of summaries if they are too frequent to be distinguished from what is logged for every message."""
    complete = [each for each in group_lines(trial.lines, trial) if each.messages > 1 and is_complete(each, trial)]
    return sum(each.repetitions for each in complete)


def is_complete(summary: Summary, trial: Trial) -> bool:
    """Whether the summary quotes a first message and a recent one."""
    firsts = {trial.sent[index].number for index in (0, *trial.jumps)}
    oldest = min(summary.messages - MAX_AGE, last_due_count(summary.messages)) - 1
    recent = {each.number for each in trial.sent[max(oldest, 0) : summary.messages_at_end]}
    quoted = list(summary.quoted)
    return any(
        first in quoted and any(last in quoted and (last != first or quoted.count(first) > 1) for last in recent)
        for first in firsts
    )


def _without_break_reports(complete: Sequence[Summary], trial: Trial) -> list[Summary]:
    """Leave out reports of a jump or restart, which may also quote a first and a recent message.

    Their wording differs from that of the summaries, if there are summaries elsewhere.
    """
    in_summaries = {
        kind
        for summary in complete
        if is_in_time(summary, trial) and not _is_at_break(summary, trial)
        for kind in summary.kinds
    }
    return [
        summary
        for summary in complete
        if not in_summaries or summary.kinds & in_summaries or not _is_at_break(summary, trial)
    ]


def _is_at_break(summary: Summary, trial: Trial) -> bool:
    """Whether the summary came right after a break, and quotes nothing newer than the message after the break."""
    quoted = [
        index for index, each in enumerate(trial.sent[: summary.messages_at_end]) if each.number in summary.quoted
    ]
    newest = max(quoted, default=0)
    return any(
        newest in (index - 1, index) and 0 <= summary.at - trial.sent[index].at <= trial.summary_limit_s
        for index in trial.jumps
    )


def _with_similar(complete: Sequence[Summary], candidates: Iterable[Summary]) -> tuple[Summary, ...]:
    """The complete summaries, and the candidates with most kinds of lines of one of them."""
    return tuple(
        each
        for each in candidates
        if each in complete or any(2 * len(each.kinds & one.kinds) > len(one.kinds) for one in complete)
    )


def _without_coincidences(
    summaries: Sequence[Summary], candidates: Iterable[Summary], trial: Trial
) -> tuple[Summary, ...]:
    """The summaries without lines that only happened to be logged together with them.

    Such kinds of lines also come separately, at times when no summary is due; when one is due, they may be the rest of
    a summary that was split.
    """
    separate = [each for each in candidates if each not in summaries and each.messages % SUMMARY_EVERY > MAX_AGE]
    elsewhere = {line.kind for each in separate for line in each.lines}
    return tuple(_without(summary, elsewhere, trial) for summary in summaries)


def _without(summary: Summary, kinds: Container[tuple[int, str]], trial: Trial) -> Summary:
    """The summary without lines of these kinds, if it is just as complete without them."""
    rest = Summary(tuple(line for line in summary.lines if line.kind not in kinds))
    return rest if rest.lines and is_complete(rest, trial) >= is_complete(summary, trial) else summary


def _find_best_family(candidates: Sequence[Summary], trial: Trial) -> tuple[Summary, ...]:
    """Choose among incomplete candidates the family that most often states a total or quotes a message when due."""

    def score(family: Sequence[Summary]) -> tuple[int, int]:
        due = [each for each in family if is_in_time(each, trial)]
        telling = [each for each in due if each.quoted or any(map(each.states, possible_totals(each, trial)))]
        return len({last_due_count(each.messages) for each in telling}), -len(family)

    families = [_with_similar([each], candidates) for each in candidates if each.kinds]
    best = max(families, key=score, default=())
    return best if best and score(best)[0] else ()


def group_lines(lines: Sequence[Line], trial: Trial) -> tuple[Summary, ...]:
    """Group lines logged at once, or between the same two messages; join groups that are only complete together.

    Lines logged just before a summary was due are not part of it.
    """
    groups: list[Summary] = []
    for line in lines:
        before = groups[-1].lines[-1] if groups else None
        at_once = (
            before
            and line.at - before.at <= AT_ONCE_S
            and last_due_count(line.messages) == last_due_count(before.messages)
        )
        if before and (line.messages == before.messages or at_once):
            groups[-1] = Summary((*groups[-1].lines, line))
        else:
            groups.append(Summary((line,)))
    joined: list[Summary] = []
    for group in groups:
        if joined and (whole := _join(joined[-1], group, trial)):
            joined[-1] = whole
        else:
            joined.append(group)
    return tuple(joined)


def _join(one: Summary, other: Summary, trial: Trial) -> Summary | None:
    """Join two parts of a summary that was interrupted by a message; None if they do not belong together."""
    whole = Summary(one.lines + other.lines)
    soon = other.at - one.at <= SOON_S and last_due_count(other.messages) == last_due_count(one.messages) > 0
    separate = not is_complete(one, trial) and not is_complete(other, trial) and not one.kinds & other.kinds
    return whole if soon and separate and is_complete(whole, trial) else None


def slots(summaries: Sequence[Summary]) -> list[tuple[Number, ...]] | None:
    """The numbers of equally worded summaries, grouped by position; None if the wording differs."""
    if any(
        [line.kind for line in one.lines] != [line.kind for line in other.lines] for one, other in pairwise(summaries)
    ):
        return None
    rows = [summary.numbers for summary in summaries]
    return list(zip(*rows, strict=True)) if len({len(row) for row in rows}) == 1 else None
