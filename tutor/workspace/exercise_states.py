"""How far a learner is with an exercise: the one answer that the app, the command line and the checklist give."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum

from tutor.content import Lesson
from tutor.workspace.layout import Workspace
from tutor.workspace.progress import ExerciseProgress, Progress
from tutor.workspace.submissions import is_started


class State(Enum):
    """How far a learner is; the values are those of `list --format json`."""

    PASSED = "passed"
    NOT_PASSED = "not_passed"
    STARTED = "started"
    NOT_STARTED = "not_started"


@dataclass(frozen=True, slots=True)
class ExerciseState:
    """One exercise. `met` and `bonus_met` hold the ids of the required and the bonus criteria that are met.

    `missed` are the required ones that were judged and are not met; of the others, nothing is known.
    """

    state: State
    required: tuple[str, ...]
    bonus: tuple[str, ...]
    met: tuple[str, ...]
    missed: tuple[str, ...]
    bonus_met: tuple[str, ...]

    @property
    def is_passed(self) -> bool:
        """Whether the exercise has been passed."""
        return self.state is State.PASSED

    @property
    def is_started(self) -> bool:
        """Whether there is anything of it yet."""
        return self.state is not State.NOT_STARTED

    @property
    def is_attempted(self) -> bool:
        """Whether it has been checked."""
        return self.state in (State.PASSED, State.NOT_PASSED)

    @property
    def count(self) -> str:
        """How many of the required criteria are met, as in "5 of 6"."""
        return f"{len(self.met)} of {len(self.required)}"


def last_met(criteria: Iterable[str], progress: ExerciseProgress) -> dict[str, bool]:
    """Of these criteria those that were ever judged, and whether each passed the last time that it was."""
    criteria = tuple(criteria)
    met: dict[str, bool] = {}
    for attempt in progress.attempts:
        met |= {id: id in attempt.passed for id in attempt.judged_of(criteria)}
    return met


def exercise_state(lesson: Lesson, progress: ExerciseProgress, *, has_files: bool = False) -> ExerciseState:
    """How far the learner is. `has_files`: the exercise's files are in the workspace, no matter who put them there.

    A criterion is met where it passed in the last check that judged it. An exercise that has been passed stays so, with
    all that it requires.
    """
    required = tuple(criterion.id for criterion in lesson.criteria if not criterion.bonus)
    bonus = tuple(criterion.id for criterion in lesson.criteria if criterion.bonus)
    passed = progress.is_passed
    met = last_met((*required, *bonus), progress)
    if passed:
        state = State.PASSED
    elif progress.attempts:
        state = State.NOT_PASSED
    else:
        state = State.STARTED if progress.started_at or has_files else State.NOT_STARTED
    return ExerciseState(
        state,
        required,
        bonus,
        met=required if passed else tuple(id for id in required if met.get(id)),
        missed=() if passed else tuple(id for id in required if met.get(id) is False),
        bonus_met=tuple(id for id in bonus if met.get(id)),
    )


def states_of(lessons: Iterable[Lesson], progress: Progress, workspace: Workspace) -> dict[str, ExerciseState]:
    """How far the learner is with each exercise, by its id. Looks for its files on the disk."""
    return {
        lesson.id: exercise_state(lesson, progress.of(lesson.id), has_files=is_started(lesson, None, workspace))
        for lesson in lessons
    }
