"""Results of a check: one object that every report format and front end renders."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from tutor.judge.verdict import Status, Verdict

_NUMBER = re.compile(r"\d+(?:\.\d+)?")


@dataclass(frozen=True, slots=True)
class CriterionResult:
    """One judged criterion. `duration_s` is the time in seconds from the start of the check to the verdict."""

    id: str
    text: str
    bonus: bool
    verdict: Verdict
    duration_s: float


@dataclass(frozen=True, slots=True)
class Remark:
    """What works, but will bite: a mistake of the catalogue in a submission that passed. It changes no verdict.

    `file` and `line` say where.
    """

    mistake: str
    text: str
    file: str
    line: int


@dataclass(frozen=True, slots=True)
class Lookup:
    """Where files were missing: `looked_for` are their paths, `found` the names of what is in the first folder."""

    looked_for: tuple[str, ...]
    found: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ExerciseResult:
    """One judged exercise. `submission` holds the names of the judged files; empty if there were none.

    `unjudged`: the ids of criteria that were skipped because the check was to stop at its first failure. `digests`: the
    digest of each of these files when the check began (see `tutor.workspace.digests`). `given`: the ids of the criteria
    that the submission can only meet by code that came with the skeleton. `remarks`: at most two, if everything
    required passed. `lookup`: what was looked for, if there was nothing to judge. `not_shown`: the ids of the checklist
    items of which it shows nothing, whatever it passes.
    """

    id: str
    title: str
    submission: tuple[str, ...]
    criteria: tuple[CriterionResult, ...]
    duration_s: float
    unjudged: tuple[str, ...] = ()
    digests: Mapping[str, str] = field(default_factory=dict)
    given: tuple[str, ...] = ()
    remarks: tuple[Remark, ...] = ()
    lookup: Lookup | None = None
    not_shown: tuple[str, ...] = ()

    @property
    def missing(self) -> str:
        """Why there was nothing to judge, in a few words ("not started"); empty if there was something."""
        return self.criteria[0].verdict.cause if self.criteria and not self.submission else ""

    @property
    def mistakes(self) -> tuple[str, ...]:
        """The mistakes by which required criteria failed, each once, in the order of the criteria."""
        return tuple(dict.fromkeys(c.verdict.mistake for c in self.criteria if c.verdict.mistake and not c.bonus))

    @property
    def verdict(self) -> Status:
        """`PASSED` if every required criterion passed; `ERROR` if one could not be judged and none failed.

        A check of bonus criteria only has passed, since nothing required is missing. A missing submission has failed
        beside others that were judged; where nothing at all was, its criteria say `ERROR`, and so does it.
        """
        if self.missing:
            return Status.ERROR if self.criteria[0].verdict.status is Status.ERROR else Status.FAILED
        required = [c.verdict.status for c in self.criteria if not c.bonus]
        return overall(required) if required or not self.criteria else Status.PASSED


@dataclass(frozen=True, slots=True)
class Environment:
    """The software that the check ran on. `ros` is "bundled" or "system"."""

    ros_distro: str
    ros: str
    rmw: str
    ros_tutor: str


@dataclass(frozen=True, slots=True)
class Restriction:
    """A restriction on the submission. `stands`: it is in force. `detail`: its extent or, if not in force, why not."""

    name: str
    stands: bool
    detail: str


@dataclass(frozen=True, slots=True)
class Report:
    """Everything that one `check` found. `isolation` is empty unless it was requested.

    `message`: why nothing could be judged; empty if something was.
    """

    environment: Environment
    exercises: tuple[ExerciseResult, ...]
    duration_s: float
    isolation: tuple[Restriction, ...] = ()
    message: str = ""

    @property
    def verdict(self) -> Status:
        """`PASSED` if every exercise passed; `ERROR` if one could not be judged and none failed."""
        return overall(e.verdict for e in self.exercises)


def overall(statuses: Iterable[Status]) -> Status:
    """Fold statuses into one of `PASSED`, `FAILED`, `ERROR`.

    A failure outweighs an error, since it is a finding. A skipped criterion counts as a failure unless an error
    explains it. No status at all is an error: there is no verdict to give.
    """
    seen = set(statuses)
    if Status.FAILED in seen:
        return Status.FAILED
    if Status.ERROR in seen or not seen:
        return Status.ERROR
    return Status.FAILED if Status.SKIPPED in seen else Status.PASSED


def tell_roots_once(criteria: Sequence[CriterionResult]) -> tuple[CriterionResult, ...]:
    """Let criteria that fail for the same reason point to the first of them, required ones first."""
    roots: dict[tuple[str, str], str] = {}
    for criterion in sorted(criteria, key=lambda criterion: criterion.bonus):
        if criterion.verdict.mistake:
            roots.setdefault(_root(criterion.verdict), criterion.id)
    told = []
    for criterion in criteria:
        root = roots.get(_root(criterion.verdict), criterion.id) if criterion.verdict.mistake else criterion.id
        if root != criterion.id:
            verdict = replace(criterion.verdict, cause=f"for the same reason as `{root}`", step="", same_as=root)
            criterion = replace(criterion, verdict=verdict)
        told.append(criterion)
    return tuple(told)


def _root(verdict: Verdict) -> tuple[str, str]:
    """What makes two failures the same: the mistake's name, and its root or place, or its words without numbers."""
    return verdict.cause.partition(":")[0], verdict.root or verdict.place or _NUMBER.sub("", verdict.cause)
