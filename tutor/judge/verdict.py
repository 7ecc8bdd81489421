"""What a criterion ends in, and why."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import Enum

MOST_CHARACTERS, MOST_OF_A_HINT, MOST_OF_A_LINE, MOST_LINES = 2000, 10_000, 500, 20
"""How long the texts of a verdict are at most, its hint (which may be a whole program), and its evidence."""

BUSY_HINT = "close what keeps this machine busy, then check again"


class Status(Enum):
    """How a criterion ended.

    `FAILED` speaks of the learner's code only; a fault of the tool or the machine is `ERROR`.
    """

    PASSED = "passed"
    FAILED = "failed"
    SKIPPED = "skipped"
    ERROR = "error"


@dataclass(frozen=True, slots=True)
class Cause:
    """A likely reason for a failure.

    `name` is the short, stable name that a learner can look up ("no spin"), `text` says what that means here, `hint`
    the next step to take.
    """

    name: str
    text: str
    hint: str

    def __str__(self) -> str:
        return f"{self.name}: {self.text}"


@dataclass(frozen=True, slots=True)
class Verdict:
    """The diagnosis of one criterion: a status and what was expected, observed, concluded and advised.

    `observed` holds numbers with their units; `evidence` holds single lines to show as they are (log lines, samples,
    the learner's own code line), oldest first.
    """

    status: Status
    expected: str = ""
    observed: str = ""
    cause: str = ""
    hint: str = ""
    evidence: tuple[str, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether the criterion is met."""
        return self.status is Status.PASSED


def bounded(verdict: Verdict) -> Verdict:
    """The verdict with texts and evidence of bounded length: they may hold what a learner's program has written."""
    return replace(
        verdict,
        expected=_cut(verdict.expected, MOST_CHARACTERS),
        observed=_cut(verdict.observed, MOST_CHARACTERS),
        cause=_cut(verdict.cause, MOST_CHARACTERS),
        hint=_cut(verdict.hint, MOST_OF_A_HINT),
        evidence=tuple(_cut(line, MOST_OF_A_LINE) for line in verdict.evidence[:MOST_LINES]),
    )


def _cut(text: str, most: int) -> str:
    return text if len(text) <= most else f"{text[: most - 3]}..."


class Undecided(Verdict):
    """The machine was too busy to tell the learner's doing from its own: see `undecided`."""

    __slots__ = ()


def undecided(to_do: str) -> Undecided:
    """The machine was too busy to judge the criterion; `to_do` completes that sentence: "to measure the timer".

    The engine repeats the scenarios alone, and has the criterion judged again; what stays undecided is an error.
    """
    return Undecided(Status.ERROR, cause=f"this machine is too busy {to_do}", hint=BUSY_HINT)


def passed(expected: str, observed: str, evidence: Iterable[str] = ()) -> Verdict:
    """The criterion is met."""
    return Verdict(Status.PASSED, expected=expected, observed=observed, evidence=tuple(evidence))


def failed(expected: str, observed: str, cause: Cause, evidence: Iterable[str] = ()) -> Verdict:
    """The learner's code does not meet the criterion; `cause` names why and what to do next."""
    return Verdict(Status.FAILED, expected, observed, str(cause), cause.hint, tuple(evidence))


def skipped(because: str) -> Verdict:
    """The criterion was not judged because something that it depends on did not pass."""
    return Verdict(Status.SKIPPED, cause=because)


def fault(what: str, hint: str, evidence: Iterable[str] = ()) -> Verdict:
    """The tool or the machine could not judge the criterion: `what` went wrong, and `hint` says how to fix it."""
    return Verdict(Status.ERROR, cause=what, hint=hint, evidence=tuple(evidence))
