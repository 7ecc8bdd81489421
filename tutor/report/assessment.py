"""A learner's overall progress: the checklist with ticks and evidence from checks, and the state of each exercise."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from tutor.content import ChecklistItem, Course, CriterionText, Lesson
from tutor.workspace import ExerciseProgress, Progress, exercise_state


@dataclass(frozen=True, slots=True)
class Evidence:
    """A criterion that passed, or the exercise as a whole if `criterion` is empty.

    `at` is the last time it passed (UTC, ISO 8601), or empty if that is no longer known.
    """

    exercise: str
    criterion: str
    at: str


@dataclass(frozen=True, slots=True)
class Source:
    """What could give evidence: some criteria of an exercise, or the exercise as a whole if `criteria` is empty."""

    exercise: str
    criteria: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class AssessedItem:
    """One checklist item. `ticked_at` is None if it is not ticked; `evidence` is sorted by time, latest first."""

    id: str
    text: str
    ticked_at: str | None
    evidence: tuple[Evidence, ...]
    sources: tuple[Source, ...]

    @property
    def ticked(self) -> bool:
        """Whether the learner has ticked the item."""
        return self.ticked_at is not None


@dataclass(frozen=True, slots=True)
class AssessedGroup:
    """The checklist items on one subject."""

    id: str
    title: str
    items: tuple[AssessedItem, ...]

    @property
    def ticked(self) -> int:
        """The number of ticked items."""
        return sum(item.ticked for item in self.items)


@dataclass(frozen=True, slots=True)
class AssessedExercise:
    """One exercise. `met` and `bonus_met` count the criteria that are met (see `tutor.workspace.exercise_states`).

    `passed_at` and `last_at` are UTC times in ISO 8601, or None if there is none or it is no longer known.
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
        """The learner's progress on the exercise, in words."""
        if self.passed:
            return "passed"
        if self.attempts:
            return "not passed yet"
        return "started" if self.started else "not started"


@dataclass(frozen=True, slots=True)
class Assessment:
    """The whole assessment. `ready_title` and `ready_text` are shown once every item is ticked."""

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
        """The number of ticked items."""
        return sum(group.ticked for group in self.groups)

    @property
    def ready(self) -> bool:
        """Whether every item is ticked, and there is at least one."""
        return self.ticked == len(self.items) > 0

    @property
    def passed(self) -> int:
        """The number of passed exercises."""
        return sum(exercise.passed for exercise in self.exercises)


def assess(course: Course, progress: Progress) -> Assessment:
    """Combine the course's checklist and exercises with the learner's progress."""
    checklist = course.checklist
    return Assessment(
        groups=tuple(
            AssessedGroup(group.id, group.title, tuple(_assess_item(item, course, progress) for item in group.items))
            for group in checklist.groups
        ),
        exercises=tuple(_assess_exercise(lesson, progress.of(lesson.id)) for lesson in course.lessons),
        ready_title=checklist.ready_title,
        ready_text=checklist.ready_text,
    )


def _assess_item(item: ChecklistItem, course: Course, progress: Progress) -> AssessedItem:
    evidence: list[Evidence] = []
    sources: list[Source] = []
    for lesson in course.lessons:
        if item.id not in lesson.checklist:
            continue
        criteria = [criterion for criterion in lesson.criteria if item.id in criterion.shows]
        sources.append(Source(lesson.id, tuple(criterion.id for criterion in criteria)))
        evidence += _find_evidence(lesson, criteria, progress.of(lesson.id))
    evidence.sort(key=lambda each: each.at, reverse=True)  # stable: evidence of the same time keeps the lesson's order
    return AssessedItem(item.id, item.text, progress.ticks.get(item.id), tuple(evidence), tuple(sources))


def _find_evidence(lesson: Lesson, criteria: list[CriterionText], progress: ExerciseProgress) -> Iterator[Evidence]:
    if not criteria and progress.is_passed:
        passes = [attempt.at for attempt in progress.attempts if attempt.is_pass]
        yield Evidence(lesson.id, "", passes[-1] if passes else "")
    for criterion in criteria:
        # A criterion that the untouched skeleton passes is evidence only once the whole exercise is passed.
        counted = [attempt for attempt in progress.attempts if criterion.open or attempt.is_pass]
        at = [attempt.at for attempt in counted if criterion.id in attempt.passed]
        if at:
            yield Evidence(lesson.id, criterion.id, at[-1])
        elif progress.is_passed and not criterion.bonus:
            yield Evidence(lesson.id, criterion.id, "")  # passed so long ago that the attempt has been dropped


def _assess_exercise(lesson: Lesson, progress: ExerciseProgress) -> AssessedExercise:
    state = exercise_state(lesson, progress)
    passes = [attempt for attempt in progress.attempts if attempt.is_pass]
    return AssessedExercise(
        id=lesson.id,
        title=lesson.title,
        difficulty=lesson.difficulty.value,
        passed=state.is_passed,
        started=progress.started_at is not None,
        met=len(state.met),
        required=len(state.required),
        bonus_met=len(state.bonus_met),
        bonus=len(state.bonus),
        attempts=len(progress.attempts),
        passed_at=passes[0].at if passes else None,
        last_at=progress.last.at if progress.last else None,
    )
