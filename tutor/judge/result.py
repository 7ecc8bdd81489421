"""Results: one object that every report format and front end renders."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from tutor.judge.verdict import Status, Verdict


@dataclass(frozen=True, slots=True)
class CriterionResult:
    """One criterion, judged. `duration_s` is the time in seconds from the start of the check to its verdict."""

    id: str
    text: str
    bonus: bool
    verdict: Verdict
    duration_s: float


@dataclass(frozen=True, slots=True)
class ExerciseResult:
    """One exercise, judged. `submission` holds the names of the files that were judged: none where none were there.

    `unjudged`: the ids of the criteria that were skipped since the check was to end at its first failure.
    """

    id: str
    title: str
    submission: tuple[str, ...]
    criteria: tuple[CriterionResult, ...]
    duration_s: float
    unjudged: tuple[str, ...] = ()

    @property
    def missing(self) -> str:
        """Why there was nothing to judge, in a few words ("not started"); empty where there was."""
        return self.criteria[0].verdict.cause if self.criteria and not self.submission else ""

    @property
    def verdict(self) -> Status:
        """`PASSED` if every required criterion passed; `ERROR` if one could not be judged and none failed.

        Where bonus criteria alone were asked for, nothing required is missing. What was not there is not passed.
        """
        if self.missing:
            return Status.FAILED
        required = [c.verdict.status for c in self.criteria if not c.bonus]
        return overall(required) if required or not self.criteria else Status.PASSED


@dataclass(frozen=True, slots=True)
class Environment:
    """What the check ran on. `ros` is "bundled" or "system"."""

    ros_distro: str
    ros: str
    rmw: str
    ros_tutor: str


@dataclass(frozen=True, slots=True)
class Restriction:
    """What the submission was kept from, if it `stands`. `detail`: how far; where it does not stand, why."""

    name: str
    stands: bool
    detail: str


@dataclass(frozen=True, slots=True)
class Report:
    """Everything that one `check` found. `isolation`: empty, unless it was asked for."""

    environment: Environment
    exercises: tuple[ExerciseResult, ...]
    duration_s: float
    isolation: tuple[Restriction, ...] = ()

    @property
    def verdict(self) -> Status:
        """`PASSED` if every exercise passed; `ERROR` if one could not be judged and none failed."""
        return overall(e.verdict for e in self.exercises)


def overall(statuses: Iterable[Status]) -> Status:
    """Fold statuses into one of `PASSED`, `FAILED`, `ERROR`.

    A failure outweighs a fault, since it is a finding; a skipped required criterion is a failure unless a fault
    explains it. Nothing judged at all is a fault: there is no verdict to give.
    """
    seen = set(statuses)
    if Status.FAILED in seen:
        return Status.FAILED
    if Status.ERROR in seen or not seen:
        return Status.ERROR
    return Status.FAILED if Status.SKIPPED in seen else Status.PASSED
