"""Verdicts: how a criterion ended, and why."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import Enum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tutor.judge.symptom import Observation

MAX_CHARACTERS, MAX_LINE_CHARACTERS, MAX_LINES = 2000, 500, 20
"""Size limits of a verdict: its texts, each line and all lines of evidence."""

BUSY_STEP = "close what keeps this machine busy, then check again"


class Status(Enum):
    """How a criterion ended.

    `FAILED` is always about the learner's code; a fault of the tool or the machine is `ERROR`.
    """

    PASSED = "passed"
    FAILED = "failed"
    SKIPPED = "skipped"
    ERROR = "error"


@dataclass(frozen=True, slots=True)
class Verdict:
    """The diagnosis of one criterion: a status, and what was expected, observed, concluded and advised.

    `observed` contains numbers with units; `evidence` holds single lines to show verbatim (log lines, samples, the
    learner's own line of code), oldest first. Of a failure, `mistake` is its id in the catalogue, `cause` says why, and
    `step` what to change, in words; `place` is the file and line, such as "node.py:12", if one is known. `same_as`: the
    id of the criterion whose failure explains this one; then cause and step are told there. `root`: what failures for
    the same reason have in common, apart from the mistake; if empty, the place, or else the words of the cause.
    `spins`: whether the node was seen to spin, None if nothing shows it.
    """

    status: Status
    expected: str = ""
    observed: str = ""
    cause: str = ""
    step: str = ""
    evidence: tuple[str, ...] = ()
    mistake: str = ""
    place: str = ""
    same_as: str = ""
    root: str = ""
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
        step=_truncate(verdict.step, MAX_CHARACTERS),
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
    return Undecided(Status.ERROR, cause=f"this machine is too busy {to_do}", step=BUSY_STEP)


def passed(expected: str, observed: str, evidence: Iterable[str] = (), *, spins: bool | None = None) -> Verdict:
    """The criterion is met."""
    return Verdict(Status.PASSED, expected=expected, observed=observed, evidence=tuple(evidence), spins=spins)


@dataclass(frozen=True, slots=True)
class Failure(Verdict):
    """A failure whose reason is still to be found: `seen` is the symptom, of which the catalogue is asked."""

    seen: Observation | None = None


def failed(expected: str, observed: str, why: Observation, evidence: Iterable[str] = ()) -> Verdict:
    """The learner's code does not meet the criterion; `why` is the symptom that was seen."""
    return Failure(Status.FAILED, expected, observed, evidence=tuple(evidence), seen=why)


def skipped(because: str) -> Verdict:
    """The criterion was not judged, because something that it depends on did not pass."""
    return Verdict(Status.SKIPPED, cause=because)


def fault(what: str, step: str, evidence: Iterable[str] = ()) -> Verdict:
    """The tool or the machine could not judge the criterion: `what` went wrong, and `step` says how to fix it."""
    return Verdict(Status.ERROR, cause=what, step=step, evidence=tuple(evidence))
