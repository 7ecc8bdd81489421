"""I1.2: whether a summary states the true total."""

from __future__ import annotations

from checks.i1_2.facts import SUMMARY_EVERY, Trial
from checks.i1_2.reading import Number
from checks.i1_2.summaries import Summary, find_summaries, possible_totals


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


def may_lack_lost_messages(summary: Summary, trial: Trial, *, starts: tuple[int, ...] = (0,)) -> bool:
    """Whether a summary states one message fewer, or two, which a node that keeps one may have lost on this machine.

    `starts`: how many messages had come when the node may have begun to count.
    """
    fewer = {summary.messages - start - lost for start in starts for lost in (1, 2)}
    hurried = any(trial.was_hurried(messages) for messages in range(1, summary.messages + 1))
    return hurried and any(total > 0 and summary.states(total) for total in fewer)


def total_as_rate(summary: Summary, trial: Trial) -> Number | None:
    """The number that states the true total, if its unit says that it is a rate; None if another one states it, too."""
    stating = [number for number in summary.numbers if true_total(summary, trial) in number.values]
    return stating[0] if stating and all(number.per_second for number in stating) else None


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
