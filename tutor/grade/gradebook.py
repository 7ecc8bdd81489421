"""The gradebook of a class: its learners, exercises, results and points, from which every format is made."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from tutor.content import Course, Lesson
from tutor.grade.learners import Learner
from tutor.grade.points import Points, Score
from tutor.grade.results import Result


@dataclass(frozen=True, slots=True)
class Total:
    """The points of a learner. `score` leaves out what could not be judged; then `complete` is false."""

    score: float
    max_score: float
    complete: bool


@dataclass(frozen=True, slots=True)
class Gradebook:
    """All results of a class. `lessons` in the course's order, `learners` by name.

    `steps`: whether learners are told the next step of a failure. `title`: of the class, for headings.
    """

    lessons: tuple[Lesson, ...]
    learners: tuple[Learner, ...]
    points: Points
    results: dict[tuple[str, str], Result] = field(default_factory=dict)
    steps: bool = True
    title: str = "Class"

    @classmethod
    def of(
        cls, results: Iterable[Result], course: Course, points: Points, *, steps: bool = True, title: str = "Class"
    ) -> Gradebook:
        """Make a gradebook of these results; those of exercises that the course does not have are left out."""
        by_key = {(result.learner.id, result.exercise): result for result in results if course.knows(result.exercise)}
        learners = {result.learner.id: result.learner for result in by_key.values()}
        ordered = sorted(learners.values(), key=lambda learner: (learner.name.casefold(), learner.id))
        seen = {exercise for _, exercise in by_key}
        lessons = tuple(lesson for lesson in course.lessons if lesson.id in seen)
        return cls(lessons, tuple(ordered), points, by_key, steps, title)

    def result(self, learner: Learner, lesson: Lesson) -> Result | None:
        """Return a result; None if this exercise has not been graded for this learner."""
        return self.results.get((learner.id, lesson.id))

    def results_of(self, learner: Learner) -> Sequence[Result]:
        """Return a learner's results, in the course's order."""
        results = (self.result(learner, lesson) for lesson in self.lessons)
        return [result for result in results if result is not None]

    def max_score(self, lesson: Lesson) -> float:
        """Return what an exercise is worth, without bonus."""
        return next(self.points.score(result).max_score for (_, id), result in self.results.items() if id == lesson.id)

    def score(self, learner: Learner, lesson: Lesson) -> Score | None:
        """Return the points of a learner's exercise; None if it has not been graded."""
        result = self.result(learner, lesson)
        return None if result is None else self.points.score(result)

    def total(self, learner: Learner) -> Total:
        """Return the points of a learner, all exercises together."""
        scores = [score for lesson in self.lessons if (score := self.score(learner, lesson)) is not None]
        return Total(
            sum(score.score for score in scores if score.score is not None),
            sum(score.max_score for score in scores),
            len(scores) == len(self.lessons) and all(score.score is not None for score in scores),
        )

    @property
    def errors(self) -> Sequence[Result]:
        """The results of which some points are not known, since a fault left them unjudged, by learner and exercise."""
        return [
            result
            for learner in self.learners
            for lesson in self.lessons
            if (result := self.result(learner, lesson)) is not None and self.points.score(result).score is None
        ]

    def mistakes(self, lesson: Lesson) -> list[tuple[str, str, int]]:
        """Return the mistakes in an exercise, the most frequent first: id, name, and how many learners made it."""
        counts: Counter[str] = Counter()
        names: dict[str, str] = {}
        for learner in self.learners:
            result = self.result(learner, lesson)
            judged = result.judged if result is not None else None
            for mistake in judged.mistakes if judged is not None else ():
                counts[mistake] += 1
            for criterion in judged.criteria if judged is not None else ():
                if criterion.verdict.mistake and not criterion.verdict.same_as:
                    names.setdefault(criterion.verdict.mistake, criterion.verdict.cause.partition(":")[0])
        return [(mistake, names.get(mistake, mistake), count) for mistake, count in counts.most_common()]
