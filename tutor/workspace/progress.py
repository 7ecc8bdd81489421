"""A learner's progress as plain data, and its encoding on disk."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from enum import StrEnum
from itertools import takewhile

from tutor.json_codec import convert_to, read_document, write_document
from tutor.judge.result import ExerciseResult
from tutor.judge.verdict import Status
from tutor.workspace.digests import version_of

SCHEMA = "ros-tutor/progress/1"
MAX_ATTEMPTS = 200
"""Older attempts are dropped, except the first that passed."""


class Help(StrEnum):
    """The most that a learner has seen of how an exercise is done, in one word."""

    NONE = "none"
    HINTS = "hints"
    SOLUTION = "solution"
    ANSWERS = "answers"
    """Of a prediction only: what the program does had been seen before it was predicted right."""


@dataclass(frozen=True, slots=True)
class Attempt:
    """One check of the workspace's own files. `at` is a UTC time in ISO 8601.

    `passed` holds the ids of the criteria that passed. `whole` is False if only some criteria were judged; their ids
    are then in `judged`, which is empty otherwise. `errors` holds the ids of those that could not be judged. `version`
    identifies the content of the files (empty if unknown), `given` the criteria that they meet by the skeleton's code,
    `not_shown` the checklist items of which they show nothing, and `help` is what the learner had seen before (None if
    unknown). `mistakes` holds those by which required criteria failed.
    """

    at: str
    verdict: Status
    passed: tuple[str, ...]
    whole: bool = True
    judged: tuple[str, ...] = ()
    errors: tuple[str, ...] = ()
    version: str = ""
    given: tuple[str, ...] = ()
    help: Help | None = None
    not_shown: tuple[str, ...] = ()
    mistakes: tuple[str, ...] = ()

    @property
    def is_pass(self) -> bool:
        """Whether every criterion was judged and all required ones passed."""
        return self.whole and self.verdict is Status.PASSED

    def judged_of(self, criteria: Iterable[str]) -> list[str]:
        """Return those of `criteria` that were judged."""
        judged = (id for id in criteria if self.whole or id in self.judged or id in self.passed)
        return [id for id in judged if id not in self.errors]


@dataclass(frozen=True, slots=True)
class Predicted:
    """The latest answer to a prediction, or the first right one. `at` is a UTC time in ISO 8601.

    `seen`: the outcome had been seen before, so it was an answer from memory.
    """

    at: str
    right: bool
    seen: bool = False


@dataclass(frozen=True, slots=True)
class ExerciseProgress:
    """The progress on one exercise. `attempts` are oldest first; `hints` is the number of hints shown.

    `criterion_hint` says whether the hint for a criterion was shown, `solution_at` when our solution was first shown.
    `predictions` holds what was answered, by the prediction's id.
    """

    started_at: str | None = None
    attempts: tuple[Attempt, ...] = ()
    best: Status | None = None
    hints: int = 0
    criterion_hint: bool = False
    solution_at: str | None = None
    predictions: Mapping[str, Predicted] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.hints < 0:
            raise ValueError("hints")

    @property
    def is_passed(self) -> bool:
        """Whether the exercise has been passed, however long ago."""
        return self.best is Status.PASSED

    @property
    def first_pass(self) -> Attempt | None:
        """The attempt that passed the exercise."""
        return next((attempt for attempt in self.attempts if attempt.is_pass), None)

    @property
    def help(self) -> Help:
        """What the learner has seen so far."""
        if self.solution_at is not None:
            return Help.SOLUTION
        return Help.HINTS if self.hints or self.criterion_hint else Help.NONE

    @property
    def last(self) -> Attempt | None:
        """The latest attempt."""
        return self.attempts[-1] if self.attempts else None

    def in_a_row(self, mistake: str) -> int:
        """Return how many of the latest attempts, up to the last one, failed by this mistake one after another."""
        return sum(1 for _ in takewhile(lambda attempt: mistake in attempt.mistakes, reversed(self.attempts)))


@dataclass(frozen=True, slots=True)
class Progress:
    """The progress on all exercises, by id; `ticks` maps each ticked checklist item to when it was ticked."""

    exercises: Mapping[str, ExerciseProgress] = field(default_factory=dict)
    ticks: Mapping[str, str] = field(default_factory=dict)

    def of(self, exercise: str) -> ExerciseProgress:
        """Return the progress on one exercise; empty if there is none."""
        return self.exercises.get(exercise, ExerciseProgress())

    def with_exercise(self, exercise: str, progress: ExerciseProgress) -> Progress:
        """Return a copy in which `exercise` has this progress."""
        return replace(self, exercises={**self.exercises, exercise: progress})

    def with_start(self, exercise: str) -> Progress:
        """Return a copy in which `exercise` is started; an earlier start time is kept."""
        before = self.of(exercise)
        return self.with_exercise(exercise, replace(before, started_at=before.started_at or now()))

    def with_attempt(self, result: ExerciseResult, *, whole: bool) -> Progress:
        """Return a copy with one more attempt. Only a whole check can be the best; an error verdict is no attempt.

        Criteria left unjudged because the check ended at its first failure keep their last verdict.
        """
        if result.verdict is Status.ERROR:
            return self
        before = self.of(result.id)
        passed = tuple(c.id for c in result.criteria if c.verdict.passed)
        whole = whole and not result.unjudged
        judged = () if whole else tuple(c.id for c in result.criteria if c.id not in result.unjudged)
        errors = tuple(c.id for c in result.criteria if c.verdict.status is Status.ERROR)
        attempt = Attempt(
            now(),
            result.verdict,
            passed,
            whole,
            judged,
            errors,
            version_of(result.digests),
            result.given,
            before.help,
            result.not_shown,
            result.mistakes,
        )
        best = result.verdict if whole and not before.is_passed else before.best
        attempts = _without_oldest((*before.attempts, attempt), before.first_pass)
        started_at = before.started_at or attempt.at
        return self.with_exercise(result.id, replace(before, started_at=started_at, attempts=attempts, best=best))

    def with_hints(self, exercise: str, shown: int) -> Progress:
        """Return a copy in which this many hints of `exercise` were shown."""
        return self.with_exercise(exercise, replace(self.of(exercise), hints=shown))

    def with_criterion_hint(self, exercise: str) -> Progress:
        """Return a copy in which the hint for a criterion of `exercise` was shown."""
        return self.with_exercise(exercise, replace(self.of(exercise), criterion_hint=True))

    def with_solution(self, exercise: str) -> Progress:
        """Return a copy in which our solution of `exercise` was shown; an earlier time is kept."""
        before = self.of(exercise)
        return self.with_exercise(exercise, replace(before, solution_at=before.solution_at or now()))

    def with_prediction(self, exercise: str, prediction: str, right: bool) -> Progress:
        """Return a copy in which a prediction was answered, and its outcome seen. A right answer is kept for good."""
        before = self.of(exercise)
        former = before.predictions.get(prediction)
        if former is not None and former.right:
            return self
        answer = Predicted(now(), right, seen=former is not None)
        return self.with_exercise(exercise, replace(before, predictions={**before.predictions, prediction: answer}))

    def with_tick(self, item: str, ticked: bool = True) -> Progress:
        """Return a copy in which one checklist item is ticked or unticked."""
        others = {key: at for key, at in self.ticks.items() if key != item}
        return replace(self, ticks={**others, item: self.ticks.get(item, now())} if ticked else others)


def _without_oldest(attempts: tuple[Attempt, ...], kept: Attempt | None) -> tuple[Attempt, ...]:
    """Return the latest `MAX_ATTEMPTS`; `kept` stays among them."""
    latest = attempts[-MAX_ATTEMPTS:]
    return latest if kept is None or kept in latest else (kept, *latest[1:])


def now() -> str:
    """Return the current time as progress stores it: UTC, ISO 8601, "2026-11-21T09:30:00Z"."""
    return datetime.now(UTC).isoformat(timespec="seconds").replace("+00:00", "Z")


def encode(progress: Progress) -> str:
    """Encode progress as JSON."""
    return write_document(SCHEMA, exercises=progress.exercises, checklist=progress.ticks)


def decode(text: str) -> Progress:
    """Decode the output of `encode`. Raises ValueError with a description of the problem."""
    document = read_document(text, SCHEMA)
    return Progress(
        exercises=convert_to(dict[str, ExerciseProgress], document.get("exercises")),
        ticks=convert_to(dict[str, str], document.get("checklist")),
    )
