"""The state of each exercise, computed in one place for the app, the command line and the checklist."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum

from tutor.content import Lesson
from tutor.workspace.digests import digests_of, version_of
from tutor.workspace.layout import Workspace
from tutor.workspace.progress import ExerciseProgress, Progress
from tutor.workspace.submission_lookup import is_started


class State(Enum):
    """The state of an exercise; the values are those of `list --format json`."""

    PASSED = "passed"
    NOT_PASSED = "not_passed"
    STARTED = "started"
    NOT_STARTED = "not_started"


@dataclass(frozen=True, slots=True)
class ExerciseState:
    """The state of one exercise and its criteria, by criterion id.

    `met` and `bonus_met` are the required and the bonus criteria that are met. `missed` are the required ones that were
    judged and are not met; the other required ones have not been judged yet.
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
        """Whether the exercise has been started."""
        return self.state is not State.NOT_STARTED

    @property
    def is_attempted(self) -> bool:
        """Whether the exercise has been checked."""
        return self.state in (State.PASSED, State.NOT_PASSED)

    @property
    def count(self) -> str:
        """How many of the required criteria are met, such as "5 of 6"."""
        return f"{len(self.met)} of {len(self.required)}"


def last_met(criteria: Iterable[str], progress: ExerciseProgress) -> dict[str, bool]:
    """Return, for each of `criteria` that was ever judged, whether it passed the last time."""
    criteria = tuple(criteria)
    met: dict[str, bool] = {}
    for attempt in progress.attempts:
        met |= {id: id in attempt.passed for id in attempt.judged_of(criteria)}
    return met


def exercise_state(lesson: Lesson, progress: ExerciseProgress, *, has_files: bool = False) -> ExerciseState:
    """Return the state of an exercise. `has_files`: its files are in the workspace, whoever put them there.

    A criterion is met if it passed in the last check that judged it. An exercise that has been passed stays passed,
    with all its required criteria met.
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
    """Return the state of each exercise, by exercise id. Looks for the exercises' files on disk.

    A file that several exercises have, as those of two courses may, does not say which of them was started.
    """
    lessons = tuple(lessons)
    uses = Counter(file.name for lesson in lessons for file in lesson.files)

    def has_files(lesson: Lesson) -> bool:
        return all(uses[file.name] == 1 for file in lesson.files) and is_started(lesson, None, workspace)

    return {
        lesson.id: exercise_state(lesson, progress.of(lesson.id), has_files=has_files(lesson)) for lesson in lessons
    }


def versions_of(lessons: Iterable[Lesson], workspace: Workspace) -> dict[str, str]:
    """Return the version of each exercise's files in the workspace as they are now, by exercise id. Reads them."""
    return {
        lesson.id: version_of(digests_of({file.name: workspace.path_of(file.name) for file in lesson.files}))
        for lesson in lessons
    }
