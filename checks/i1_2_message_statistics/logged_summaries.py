"""I1.2: find the summaries among log messages by their content and timing, not by their wording."""

from __future__ import annotations

from collections import Counter
from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise

from checks.i1_2_message_statistics.log_lines import Line, Number
from checks.i1_2_message_statistics.trial import SOON_S, SUMMARY_EVERY, Sent, Trial

AT_ONCE_S = 0.05
"""Lines that are logged within this time of each other belong together."""

FREQUENT_SHARE = 0.5
"""A kind of line logged for at least this share of messages is no summary line, unless summaries are as frequent."""

MAX_AGE = 4
"""A summary's last message is at most this many messages old, or the one at which the summary was due."""

NO_SUMMARY = "not judged, because there is no summary to read: see `summary`"


def last_due_count(messages: int) -> int:
    """The number of messages after which a summary was last due."""
    return messages - messages % SUMMARY_EVERY


@dataclass(frozen=True)
class Summary:
    """A summary of a trial: lines that were logged together.

    `messages`: how many had been sent when the first line was logged. `messages_at_end`: when the last one was.
    """

    lines: tuple[Line, ...]
    trial: Trial = field(compare=False, repr=False)

    @property
    def at(self) -> float:
        return self.lines[0].at

    @property
    def messages(self) -> int:
        return self.lines[0].messages

    @property
    def messages_at_end(self) -> int:
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
    def due(self) -> int:
        """The number of messages after which a summary was last due when this one came."""
        return last_due_count(self.messages)

    @property
    def is_in_time(self) -> bool:
        """Whether it was logged at the tenth, twentieth, ... message, or soon after."""
        return self.due > 0 and self.came_soon_after(self.due)

    def came_soon_after(self, count: int) -> bool:
        """Whether it came as soon after this many messages as a summary must."""
        return self.at - self.trial.sent[count - 1].at <= self.trial.summary_limit_s

    @property
    def recent(self) -> tuple[Sent, ...]:
        """The messages that it may quote as the last one: since it was due."""
        return self.trial.sent[self.due - 1 : self.messages_at_end]

    @cached_property
    def is_complete(self) -> bool:
        """Whether it quotes a first message and a recent one."""
        sent, quoted = self.trial.sent, self.quoted
        oldest = min(self.messages - MAX_AGE, self.due) - 1
        recent = {message.number for message in sent[max(oldest, 0) : self.messages_at_end]}.intersection(quoted)
        firsts = {sent[index].number for index in (0, *self.trial.jumps)}.intersection(quoted)
        return any(recent - {first} or (first in recent and quoted.count(first) > 1) for first in firsts)

    @property
    def repetitions(self) -> int:
        """How often it was logged: the same lines, with the same quotations, may be repeated."""
        for length in range(1, len(self.lines) // 2 + 1):
            times, rest = divmod(len(self.lines), length)
            parts = [self.lines[start : start + length] for start in range(0, len(self.lines), length)]
            if rest or not (any(line.quoted for line in parts[0]) and any(line.numbers for line in parts[0])):
                continue
            if len({tuple((line.kind, line.quoted) for line in part) for part in parts}) == 1:
                return times
        return 1

    def states(self, value: float) -> bool:
        """Whether it contains this number, in any notation."""
        return any(value in number.values for number in self.numbers)

    def __str__(self) -> str:
        return f"after {self.messages} messages: " + " / ".join(line.text for line in self.lines)


def find_summaries(trial: Trial) -> tuple[Summary, ...]:
    """Find the summaries in the log, complete or not, oldest first."""
    times = Counter(line.kind for line in trial.lines)
    usual = {kind for kind, count in times.items() if count >= max(3, FREQUENT_SHARE * len(trial.sent))}
    candidates = group_lines((line for line in trial.lines if line.kind not in usual), trial)
    if complete := _without_break_reports([candidate for candidate in candidates if candidate.is_complete]):
        found = _with_similar(complete, candidates)
    else:
        everything = group_lines(trial.lines, trial)
        complete = [group for group in everything if group.messages > 1 and group.is_complete]
        if len(complete) > len(trial.sent) / 4:
            candidates, found = everything, _with_similar(complete, everything)
        else:
            found = _find_best_family(candidates)
    return _without_coincidences(found, candidates)


def count_complete(trial: Trial) -> int:
    """The number of summaries if they are too frequent to be distinguished from what is logged for every message."""
    complete = [group for group in group_lines(trial.lines, trial) if group.messages > 1 and group.is_complete]
    return sum(summary.repetitions for summary in complete)


def summary_kinds(trial: Trial) -> set[tuple[int, str]]:
    """The kinds of lines that tell something in a summary."""
    return {kind for summary in find_summaries(trial) for kind in summary.kinds}


def _without_break_reports(complete: Sequence[Summary]) -> list[Summary]:
    """Leave out reports of a jump or restart, which may also quote a first and a recent message.

    Their wording differs from that of the summaries, if there are summaries elsewhere.
    """
    elsewhere = [summary for summary in complete if not _is_at_break(summary)]
    kinds = {kind for summary in elsewhere if summary.is_in_time for kind in summary.kinds}
    return [summary for summary in complete if not kinds or summary.kinds & kinds or summary in elsewhere]


def _is_at_break(summary: Summary) -> bool:
    """Whether the summary came right after a break, and quotes nothing newer than the message after the break."""
    trial, quoted = summary.trial, summary.quoted
    before = trial.sent[: summary.messages_at_end]
    newest = max((index for index, message in enumerate(before) if message.number in quoted), default=0)
    return any(
        newest in (index - 1, index) and 0 <= summary.at - trial.sent[index].at <= trial.summary_limit_s
        for index in trial.jumps
    )


def _with_similar(complete: Sequence[Summary], candidates: Iterable[Summary]) -> list[Summary]:
    """The complete summaries, and the candidates with most kinds of lines of one of them."""
    return [
        candidate
        for candidate in candidates
        if candidate in complete or any(2 * len(candidate.kinds & one.kinds) > len(one.kinds) for one in complete)
    ]


def _without_coincidences(summaries: Sequence[Summary], candidates: Iterable[Summary]) -> tuple[Summary, ...]:
    """The summaries without lines that only happened to be logged together with them.

    Such kinds of lines also come separately, at times when no summary is due; when one is due, they may be the rest of
    a summary that was split.
    """
    separate = [
        candidate
        for candidate in candidates
        if candidate not in summaries and candidate.messages % SUMMARY_EVERY > MAX_AGE
    ]
    elsewhere = {line.kind for candidate in separate for line in candidate.lines}
    return tuple(_without(summary, elsewhere) for summary in summaries)


def _without(summary: Summary, kinds: Container[tuple[int, str]]) -> Summary:
    """The summary without lines of these kinds, if it is just as complete without them."""
    rest = Summary(tuple(line for line in summary.lines if line.kind not in kinds), summary.trial)
    return rest if rest.lines and rest.is_complete >= summary.is_complete else summary


def _find_best_family(candidates: Sequence[Summary]) -> list[Summary]:
    """Choose among incomplete candidates the family that most often states a total or quotes a message when due."""

    def score(family: Sequence[Summary]) -> tuple[int, int]:
        due = [summary for summary in family if summary.is_in_time]
        telling = [summary for summary in due if summary.quoted or any(map(summary.states, possible_totals(summary)))]
        return len({summary.due for summary in telling}), -len(family)

    families = [_with_similar([candidate], candidates) for candidate in candidates if candidate.kinds]
    best = max(families, key=score, default=[])
    return best if best and score(best)[0] else []


def possible_totals(summary: Summary, *, before: int = 0) -> range:
    """The totals that the summary may truthfully state, if the first `before` messages do not count.

    It may have been composed a moment before it was logged, and be logged in several parts.
    """
    trial = summary.trial
    counted = earliest = summary.messages - before
    due = last_due_count(counted)
    if due > 0 and summary.came_soon_after(before + due):
        earliest = due
    elif summary.at - trial.sent[summary.messages - 1].at <= AT_ONCE_S + trial.allowance_s:
        earliest = counted - 1
    return range(max(earliest, 1), summary.messages_at_end - before + 1)


def group_lines(lines: Iterable[Line], trial: Trial) -> tuple[Summary, ...]:
    """Group lines logged at once, or between the same two messages; join groups that are only complete together.

    Lines logged just before a summary was due are not part of it.
    """
    groups: list[list[Line]] = []
    for line in lines:
        before = groups[-1][-1] if groups else None
        if before and (line.messages == before.messages or _came_at_once(before, line)):
            groups[-1].append(line)
        else:
            groups.append([line])
    joined: list[Summary] = []
    for part in (Summary(tuple(group), trial) for group in groups):
        if joined and (whole := _join(joined[-1], part)):
            joined[-1] = whole
        else:
            joined.append(part)
    return tuple(joined)


def _came_at_once(one: Line, other: Line) -> bool:
    return other.at - one.at <= AT_ONCE_S and last_due_count(other.messages) == last_due_count(one.messages)


def _join(one: Summary, other: Summary) -> Summary | None:
    """Join two parts of a summary that was interrupted by a message; None if they do not belong together."""
    whole = Summary(one.lines + other.lines, one.trial)
    soon = other.at - one.at <= SOON_S and other.due == one.due > 0
    separate = not one.is_complete and not other.is_complete and not one.kinds & other.kinds
    return whole if soon and separate and whole.is_complete else None


def slots(summaries: Sequence[Summary]) -> list[tuple[Number, ...]] | None:
    """The numbers of equally worded summaries, grouped by position; None if the wording differs."""
    if any(
        [line.kind for line in one.lines] != [line.kind for line in other.lines] for one, other in pairwise(summaries)
    ):
        return None
    rows = [summary.numbers for summary in summaries]
    return list(zip(*rows, strict=True)) if len({len(row) for row in rows}) == 1 else None
