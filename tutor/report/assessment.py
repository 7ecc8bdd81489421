"""How far a learner is: the checklist with its ticks and what the checks have shown, and each exercise's progress."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from tutor.content import ChecklistItem, Course, CriterionText, Lesson
from tutor.workspace import ExerciseProgress, Progress, State, exercise_state


@dataclass(frozen=True, slots=True)
class Evidence:
    """A criterion that passed; `criterion` is empty where the exercise as a whole is meant.

    `at` is the last time that it passed (UTC, ISO 8601), empty where that is no longer known.
    """

    exercise: str
    criterion: str
    at: str


@dataclass(frozen=True, slots=True)
class Source:
    """What could give evidence: criteria of an exercise, or the whole of it where there are none."""

    exercise: str
    criteria: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class AssessedItem:
    """One item: when it was ticked (None where it is not), what shows it, the latest first, and what could."""

    id: str
    text: str
    ticked_at: str | None
    evidence: tuple[Evidence, ...]
    sources: tuple[Source, ...]

    @property
    def ticked(self) -> bool:
        """Whether the learner has ticked it."""
        return self.ticked_at is not None


@dataclass(frozen=True, slots=True)
class AssessedGroup:
    """The items of one subject."""

    id: str
    title: str
    items: tuple[AssessedItem, ...]

    @property
    def ticked(self) -> int:
        """How many are ticked."""
        return sum(item.ticked for item in self.items)


@dataclass(frozen=True, slots=True)
class AssessedExercise:
    """One exercise. `met` and `bonus_met` count the criteria that are met (see `tutor.workspace.exercise_states`).

    `passed_at` and `last_at` are UTC times in ISO 8601, None where there is none (or it is no longer known).
    """

    id: str
    title: str
    difficulty: str
    passed: bool
    started: bool
    met: int
    required: int
    bonus_met: int
    bonus: int
    attempts: int
    passed_at: str | None
    last_at: str | None

    @property
    def status(self) -> str:
        """How far the learner is with it, in words."""
        if self.passed:
            return "passed"
        if self.attempts:
            return "not passed yet"
        return "started" if self.started else "not started"


@dataclass(frozen=True, slots=True)
class Assessment:
    """All of it. `ready_title` and `ready_text` are for anyone who has ticked every item."""

    groups: tuple[AssessedGroup, ...]
    exercises: tuple[AssessedExercise, ...]
    ready_title: str = ""
    ready_text: str = ""

    @property
    def items(self) -> tuple[AssessedItem, ...]:
        """Every item, in the order of the groups."""
        return tuple(item for group in self.groups for item in group.items)

    @property
    def ticked(self) -> int:
        """How many items are ticked."""
        return sum(group.ticked for group in self.groups)

    @property
    def ready(self) -> bool:
        """Whether there is something to tick, and all of it is ticked."""
        return self.ticked == len(self.items) > 0

    @property
    def passed(self) -> int:
        """How many exercises are passed."""
        return sum(exercise.passed for exercise in self.exercises)


def assess(course: Course, progress: Progress) -> Assessment:
    """Bring together what the course asks and what the learner has done."""
    checklist = course.checklist
    return Assessment(
        groups=tuple(
            AssessedGroup(group.id, group.title, tuple(_item(item, course, progress) for item in group.items))
            for group in checklist.groups
        ),
        exercises=tuple(_exercise(lesson, progress.of(lesson.id)) for lesson in course.lessons),
        ready_title=checklist.ready_title,
        ready_text=checklist.ready_text,
    )


def _item(item: ChecklistItem, course: Course, progress: Progress) -> AssessedItem:
    found: list[Evidence] = []
    sources: list[Source] = []
    for lesson in course.lessons:
        if item.id not in lesson.checklist:
            continue
        criteria = [criterion for criterion in lesson.criteria if item.id in criterion.shows]
        sources.append(Source(lesson.id, tuple(criterion.id for criterion in criteria)))
        found += _found(lesson, criteria, progress.of(lesson.id))
    found.sort(key=lambda each: each.at, reverse=True)  # stable: those of one moment stay in the lesson's order
    return AssessedItem(item.id, item.text, progress.ticks.get(item.id), tuple(found), tuple(sources))


def _found(lesson: Lesson, criteria: list[CriterionText], progress: ExerciseProgress) -> Iterator[Evidence]:
    if not criteria and progress.is_passed:
        passes = [attempt.at for attempt in progress.attempts if attempt.is_pass]
        yield Evidence(lesson.id, "", passes[-1] if passes else "")
    for criterion in criteria:
        # What the skeleton passes untouched shows nothing before the rest does its work as well.
        counted = [attempt for attempt in progress.attempts if criterion.open or attempt.is_pass]
        at = [attempt.at for attempt in counted if criterion.id in attempt.passed]
        if at:
            yield Evidence(lesson.id, criterion.id, at[-1])
        elif progress.is_passed and not criterion.bonus:
            yield Evidence(lesson.id, criterion.id, "")  # so long ago that the attempt is not kept any more


def _exercise(lesson: Lesson, progress: ExerciseProgress) -> AssessedExercise:
    found = exercise_state(lesson, progress)
    passes = [attempt for attempt in progress.attempts if attempt.is_pass]
    return AssessedExercise(
        id=lesson.id,
        title=lesson.title,
        difficulty=lesson.difficulty.value,
        passed=found.state is State.PASSED,
        started=progress.started_at is not None,
        met=len(found.met),
        required=len(found.required),
        bonus_met=len(found.bonus_met),
        bonus=len(found.bonus),
        attempts=len(progress.attempts),
        passed_at=passes[0].at if passes else None,
        last_at=progress.last.at if progress.last else None,
    )
