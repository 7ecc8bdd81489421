"""What a learner has done so far, as plain data, and its form on disk."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime

from tutor.json_codec import read_as, read_document, write_document
from tutor.judge.result import ExerciseResult
from tutor.judge.verdict import Status

SCHEMA = "ros-tutor/progress/1"
MOST_ATTEMPTS = 200
"""Older attempts are dropped; the best result is kept apart from them."""


@dataclass(frozen=True, slots=True)
class Attempt:
    """One check of the workspace's own files. `at` is a UTC time in ISO 8601.

    `passed` holds the ids of the criteria that passed; `whole` is False where only some criteria were asked for, which
    are `judged` (empty where all were).
    """

    at: str
    verdict: Status
    passed: tuple[str, ...]
    whole: bool = True
    judged: tuple[str, ...] = ()

    @property
    def is_pass(self) -> bool:
        """Whether everything required passed, and all of it was judged."""
        return self.whole and self.verdict is Status.PASSED

    def judged_of(self, criteria: Iterable[str]) -> list[str]:
        """Those of these criteria that were judged."""
        return [id for id in criteria if self.whole or id in self.judged or id in self.passed]


@dataclass(frozen=True, slots=True)
class ExerciseProgress:
    """One exercise: when it was started, the attempts (oldest first), the best verdict, how many hints were shown."""

    started_at: str | None = None
    attempts: tuple[Attempt, ...] = ()
    best: Status | None = None
    hints: int = 0

    def __post_init__(self) -> None:
        if self.hints < 0:
            raise ValueError("hints")

    @property
    def is_passed(self) -> bool:
        """Whether the exercise has been passed, however long ago."""
        return self.best is Status.PASSED

    @property
    def last(self) -> Attempt | None:
        """The latest attempt."""
        return self.attempts[-1] if self.attempts else None


@dataclass(frozen=True, slots=True)
class Progress:
    """Everything; `ticks` maps a ticked checklist item to when it was ticked."""

    exercises: Mapping[str, ExerciseProgress] = field(default_factory=dict)
    ticks: Mapping[str, str] = field(default_factory=dict)

    def of(self, exercise: str) -> ExerciseProgress:
        """The progress in one exercise; an empty one where there is none."""
        return self.exercises.get(exercise, ExerciseProgress())

    def with_exercise(self, exercise: str, progress: ExerciseProgress) -> Progress:
        """A copy in which `exercise` has this progress."""
        return replace(self, exercises={**self.exercises, exercise: progress})

    def with_start(self, exercise: str) -> Progress:
        """A copy in which `exercise` is started; the first time counts."""
        before = self.of(exercise)
        return self.with_exercise(exercise, replace(before, started_at=before.started_at or now()))

    def with_attempt(self, result: ExerciseResult, *, whole: bool) -> Progress:
        """A copy with one more attempt. Only a whole check can be the best; our own fault is no attempt at all.

        What was not judged, since the check ended at its first failure, is as it was.
        """
        if result.verdict is Status.ERROR:
            return self
        before = self.of(result.id)
        passed = tuple(c.id for c in result.criteria if c.verdict.passed)
        whole = whole and not result.unjudged
        judged = () if whole else tuple(c.id for c in result.criteria if c.id not in result.unjudged)
        attempt = Attempt(now(), result.verdict, passed, whole, judged)
        best = result.verdict if whole and not before.is_passed else before.best
        attempts = (*before.attempts, attempt)[-MOST_ATTEMPTS:]
        started_at = before.started_at or attempt.at
        return self.with_exercise(result.id, replace(before, started_at=started_at, attempts=attempts, best=best))

    def with_hints(self, exercise: str, shown: int) -> Progress:
        """A copy in which this many hints of `exercise` were shown."""
        return self.with_exercise(exercise, replace(self.of(exercise), hints=shown))

    def with_tick(self, item: str, ticked: bool = True) -> Progress:
        """A copy in which one checklist item is ticked or not."""
        others = {key: at for key, at in self.ticks.items() if key != item}
        return replace(self, ticks={**others, item: self.ticks.get(item, now())} if ticked else others)


def now() -> str:
    """The time, as progress holds it."""
    return datetime.now(UTC).isoformat(timespec="seconds").replace("+00:00", "Z")


def encode(progress: Progress) -> str:
    """Write progress as JSON."""
    return write_document(SCHEMA, exercises=progress.exercises, checklist=progress.ticks)


def decode(text: str) -> Progress:
    """Read what `encode` wrote. Raises ValueError, which says what is wrong."""
    document = read_document(text, SCHEMA)
    return Progress(
        exercises=read_as(dict[str, ExerciseProgress], document.get("exercises")),
        ticks=read_as(dict[str, str], document.get("checklist")),
    )
