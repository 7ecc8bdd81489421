"""A learner's overall progress: the checklist with ticks and evidence from checks, and the state of each exercise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tutor.content import ChecklistItem, Counts, Course, CriterionText, Lesson
from tutor.workspace import Attempt, ExerciseProgress, Help, Progress, exercise_state


@dataclass(frozen=True, slots=True)
class Evidence:
    """A criterion that passed, or the exercise as a whole if `criterion` is empty, or `predictions` that came true.

    `at` is the last time it passed (UTC, ISO 8601), or empty if that is no longer known. `changed`: the files have been
    changed since; None if that is not known. `help`: what the learner had seen when it passed for the first time.
    """

    exercise: str
    criterion: str
    at: str
    changed: bool | None = False
    help: Help | None = None
    predictions: tuple[str, ...] = ()

    @property
    def holds(self) -> bool:
        """Whether it is true of the files as they are now."""
        return self.changed is False


@dataclass(frozen=True, slots=True)
class Source:
    """What could give evidence: some criteria of an exercise, all of some `predictions`, or else the exercise."""

    exercise: str
    criteria: tuple[str, ...]
    predictions: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class AssessedItem:
    """One checklist item. `ticked_at` is None if it is not ticked.

    `evidence` begins with what holds now, of this with what was reached with the least help, of this with the latest.
    """

    id: str
    text: str
    ticked_at: str | None
    evidence: tuple[Evidence, ...]
    sources: tuple[Source, ...]

    @property
    def ticked(self) -> bool:
        """Whether the learner has ticked the item."""
        return self.ticked_at is not None

    @property
    def shown(self) -> bool:
        """Whether the checks of the files as they are now show it."""
        return any(piece.holds for piece in self.evidence)


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

    `passed_at` and `last_at` are UTC times in ISO 8601, or None if there is none or it is no longer known. `help`: what
    the learner had seen before the pass. `changed`: the files have been changed since. Both are None if not known.
    `beyond`: it goes beyond the course.
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
    help: Help | None = None
    changed: bool | None = None
    beyond: bool = False

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
    def counts(self) -> Counts:
        """How many exercises are passed."""
        return Counts.of(self.exercises, [exercise.id for exercise in self.exercises if exercise.passed])


def assess(course: Course, progress: Progress, versions: Mapping[str, str]) -> Assessment:
    """Combine the course's checklist and exercises with the learner's progress.

    `versions`: the version of each exercise's files now, by exercise id (see `tutor.workspace.versions_of`).
    """
    checklist = course.checklist
    return Assessment(
        groups=tuple(
            AssessedGroup(
                group.id, group.title, tuple(_assess_item(item, course, progress, versions) for item in group.items)
            )
            for group in checklist.groups
        ),
        exercises=tuple(
            _assess_exercise(lesson, progress.of(lesson.id), versions.get(lesson.id, "")) for lesson in course.lessons
        ),
        ready_title=checklist.ready_title,
        ready_text=checklist.ready_text,
    )


def _assess_item(item: ChecklistItem, course: Course, progress: Progress, versions: Mapping[str, str]) -> AssessedItem:
    found: list[Evidence | None] = []
    sources: list[Source] = []
    for lesson in course.lessons:
        if predictions := tuple(p.id for p in lesson.predictions if item.id in p.shows):
            sources.append(Source(lesson.id, (), predictions))
            found.append(_evidence_of_predictions(lesson, predictions, progress.of(lesson.id)))
        if item.id not in lesson.checklist:
            continue
        criteria = [criterion for criterion in lesson.criteria if item.id in criterion.shows]
        own, version = progress.of(lesson.id), versions.get(lesson.id, "")
        if not criteria:
            sources.append(Source(lesson.id, ()))
            found.append(_evidence_of_exercise(lesson, own, version))
        elif left_open := tuple(criterion.id for criterion in criteria if criterion.open):
            sources.append(Source(lesson.id, left_open))
        found += [_evidence_of_criterion(item, lesson, criterion, own, version) for criterion in criteria]
    evidence = [piece for piece in found if piece is not None]
    evidence.sort(key=_strength, reverse=True)  # stable: otherwise in the lesson's order
    return AssessedItem(item.id, item.text, progress.ticks.get(item.id), tuple(evidence), tuple(sources))


def _strength(evidence: Evidence) -> tuple[bool, int, str]:
    """What evidence is worth: whether it holds, with how little help it was reached, and when."""
    return evidence.holds, -list(Help).index(evidence.help or Help.NONE), evidence.at


def _evidence_of_exercise(lesson: Lesson, progress: ExerciseProgress, version: str) -> Evidence | None:
    judged = [(attempt, attempt.is_pass) for attempt in progress.attempts if attempt.whole]
    return _evidence(lesson, "", judged, version, passed_before=progress.is_passed)


def _evidence_of_predictions(
    lesson: Lesson, predictions: tuple[str, ...], progress: ExerciseProgress
) -> Evidence | None:
    """Return what predictions show: all of them must have come true, and the last one that did says when."""
    answers = [progress.predictions.get(prediction) for prediction in predictions]
    right = [answer for answer in answers if answer is not None and answer.right]
    if len(right) < len(predictions):
        return None
    help = Help.ANSWERS if any(answer.seen for answer in right) else Help.NONE
    return Evidence(lesson.id, "", max(answer.at for answer in right), help=help, predictions=predictions)


def _evidence_of_criterion(
    item: ChecklistItem, lesson: Lesson, criterion: CriterionText, progress: ExerciseProgress, version: str
) -> Evidence | None:
    def is_own(attempt: Attempt) -> bool:
        """Whether the learner's own code passed, not what came with the skeleton, and by means of the item."""
        own = criterion.open or bool(attempt.version and criterion.id not in attempt.given)
        return own and item.id not in attempt.not_shown

    judged = [
        (attempt, criterion.id in attempt.passed and is_own(attempt))
        for attempt in progress.attempts
        if attempt.judged_of([criterion.id])
    ]
    otherwise = any(item.id in attempt.not_shown for attempt in progress.attempts)
    passed_before = progress.is_passed and criterion.open and not criterion.bonus and not otherwise
    return _evidence(lesson, criterion.id, judged, version, passed_before=passed_before)


def _evidence(
    lesson: Lesson, criterion: str, judged: list[tuple[Attempt, bool]], version: str, *, passed_before: bool
) -> Evidence | None:
    """Return what the attempts show, each given with whether it is a pass. A failure of the files as they are ends it.

    `passed_before`: there was a pass, though its attempt may be on record no longer.
    """
    now = [passed for attempt, passed in judged if version and attempt.version == version]
    if now and not now[-1]:
        return None
    passes = [attempt for attempt, passed in judged if passed]
    if not passes:
        return Evidence(lesson.id, criterion, "", changed=None) if passed_before else None
    help = passes[0].help
    if now:
        at = [attempt.at for attempt in passes if attempt.version == version][-1]
        return Evidence(lesson.id, criterion, at, changed=False, help=help)
    last = passes[-1]
    if last.version:
        return Evidence(lesson.id, criterion, last.at, changed=True, help=help)
    # From before versions were recorded: the last verdict is the best that is known.
    return Evidence(lesson.id, criterion, last.at, changed=None, help=help) if judged[-1][1] else None


def _assess_exercise(lesson: Lesson, progress: ExerciseProgress, version: str) -> AssessedExercise:
    state = exercise_state(lesson, progress)
    first = progress.first_pass
    evidence = _evidence_of_exercise(lesson, progress, version)
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
        passed_at=first.at if first else None,
        last_at=progress.last.at if progress.last else None,
        help=first.help if first else None,
        changed=evidence.changed if evidence else None,
        beyond=lesson.beyond,
    )
