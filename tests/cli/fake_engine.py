"""An engine that starts nothing: it returns preset verdicts, with all the events of a real check."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from tutor.content import Course
from tutor.judge.events import CheckFinished, CheckStarted, CriterionJudged, Event, ExerciseJudged, Progress
from tutor.judge.result import CriterionResult, Environment, ExerciseResult, Report
from tutor.judge.submission import Submission
from tutor.judge.verdict import Status, Verdict, passed
from tutor.workspace import digests_of
from tutor.workspace.given_code import given_criteria


@dataclass
class FakeEngine:
    """Passes every criterion except those in `verdicts`. Records its submissions and selected criteria in `calls`."""

    verdicts: dict[str, Verdict] = field(default_factory=dict)
    raises: BaseException | None = None
    calls: list[tuple[list[Submission], frozenset[str] | None]] = field(default_factory=list)
    first: bool = False
    """Whether the last call asked to end at the first failure, which this engine ignores."""

    async def __call__(
        self,
        submissions: Sequence[Submission],
        course: Course,
        *,
        only: frozenset[str] | None,
        on_event: Callable[[Event], None],
        first: bool = False,
    ) -> Report:
        self.calls.append((list(submissions), only))
        self.first = first
        if self.raises is not None:
            raise self.raises
        report = Report(
            Environment("jazzy", "bundled", "rmw_fastrtps_cpp", "0.1.0"),
            tuple(self._judge(submission, course, only, on_event) for submission in submissions),
            1.23456,
        )
        on_event(CheckFinished(report))
        return report

    def _judge(
        self, submission: Submission, course: Course, only: frozenset[str] | None, on_event: Callable[[Event], None]
    ) -> ExerciseResult:
        lesson = course.find(submission.exercise)
        criteria = [each for each in lesson.criteria if only is None or each.id in only]
        on_event(CheckStarted(lesson.id, tuple(each.id for each in criteria)))
        results = []
        for each in criteria:
            on_event(Progress(lesson.id, each.id, 0.5, "waiting for the first message"))
            on_event(Progress(lesson.id, each.id, 0.5, "waiting for the first message", "/node is up, but silent"))
            verdict = self.verdicts.get(each.id, passed("as asked", "as asked"))
            results.append(CriterionResult(each.id, each.text, each.bonus, verdict, 0.5))
            on_event(CriterionJudged(lesson.id, results[-1]))
        result = ExerciseResult(
            lesson.id,
            lesson.title,
            tuple(submission.files),
            tuple(results),
            1.0,
            digests=digests_of(submission.files),
            given=given_criteria(lesson, submission),
        )
        on_event(ExerciseJudged(result))
        return result


FAILURE = Verdict(
    Status.FAILED,
    "5 messages",
    "0 messages",
    "no spin: no callback ran",
    "call rclpy.spin(node)",
    ("a line",),
    mistake="no-spin",
)
