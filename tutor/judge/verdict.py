"""Verdicts: how a criterion ended, and why."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import Enum

MAX_CHARACTERS, MAX_HINT_CHARACTERS, MAX_LINE_CHARACTERS, MAX_LINES = 2000, 10_000, 500, 20
"""Size limits of a verdict: its texts, its hint (which may be a whole program), each line and all lines of evidence."""

BUSY_HINT = "close what keeps this machine busy, then check again"


class Status(Enum):
    """How a criterion ended.

    `FAILED` is always about the learner's code; a fault of the tool or the machine is `ERROR`.
    """

    PASSED = "passed"
    FAILED = "failed"
    SKIPPED = "skipped"
    ERROR = "error"


@dataclass(frozen=True, slots=True)
class Cause:
    """A likely reason for a failure.

    `name` is a short, stable name that a learner can look up ("no spin"), `text` says what it means here, and `hint` is
    the next step to take.
    """

    name: str
    text: str
    hint: str

    def __str__(self) -> str:
        return f"{self.name}: {self.text}"


@dataclass(frozen=True, slots=True)
class Verdict:
    """The diagnosis of one criterion: a status, and what was expected, observed, concluded and advised.

    `observed` contains numbers with units; `evidence` holds single lines to show verbatim (log lines, samples, the
    learner's own line of code), oldest first. `spins`: whether the node was seen to spin, None if nothing shows it.
    """

    status: Status
    expected: str = ""
    observed: str = ""
    cause: str = ""
    hint: str = ""
    evidence: tuple[str, ...] = ()
    spins: bool | None = None

    @property
    def passed(self) -> bool:
        """Whether the criterion is met."""
        return self.status is Status.PASSED


def bounded(verdict: Verdict) -> Verdict:
    """The verdict with its texts and evidence truncated, since they may contain output of the learner's program."""
    return replace(
        verdict,
        expected=_truncate(verdict.expected, MAX_CHARACTERS),
        observed=_truncate(verdict.observed, MAX_CHARACTERS),
        cause=_truncate(verdict.cause, MAX_CHARACTERS),
        hint=_truncate(verdict.hint, MAX_HINT_CHARACTERS),
        evidence=tuple(_truncate(line, MAX_LINE_CHARACTERS) for line in verdict.evidence[:MAX_LINES]),
    )


def _truncate(text: str, limit: int) -> str:
    return text if len(text) <= limit else f"{text[: limit - 3]}..."


class Undecided(Verdict):
    """The machine was too busy to tell the learner's mistakes from its own delays (see `undecided`)."""

    __slots__ = ()


def undecided(to_do: str) -> Undecided:
    """The machine was too busy to judge the criterion; `to_do` completes that sentence, as in "to measure the timer".

    The engine repeats the scenarios with nothing else running and judges again; if still undecided, it is an error.
    """
    return Undecided(Status.ERROR, cause=f"this machine is too busy {to_do}", hint=BUSY_HINT)


def passed(expected: str, observed: str, evidence: Iterable[str] = (), *, spins: bool | None = None) -> Verdict:
    """The criterion is met."""
    return Verdict(Status.PASSED, expected=expected, observed=observed, evidence=tuple(evidence), spins=spins)


def failed(expected: str, observed: str, cause: Cause, evidence: Iterable[str] = ()) -> Verdict:
    """The learner's code does not meet the criterion; `cause` names why and what to do next."""
    return Verdict(Status.FAILED, expected, observed, str(cause), cause.hint, tuple(evidence))


def skipped(because: str) -> Verdict:
    """The criterion was not judged, because something that it depends on did not pass."""
    return Verdict(Status.SKIPPED, cause=because)


def fault(what: str, hint: str, evidence: Iterable[str] = ()) -> Verdict:
    """The tool or the machine could not judge the criterion: `what` went wrong, and `hint` says how to fix it."""
    return Verdict(Status.ERROR, cause=what, hint=hint, evidence=tuple(evidence))
