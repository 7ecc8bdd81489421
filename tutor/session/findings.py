"""The state of one exercise's check, built from its events. Plain data, independent of widgets and processes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from tutor.content import Lesson
from tutor.judge.events import CheckFinished, CheckStarted, CriterionJudged, Event, ExerciseJudged, Progress
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Verdict, fault
from tutor.workspace import ExerciseProgress, LastCheck, last_met


@dataclass(frozen=True, slots=True)
class Finding:
    """The state of one criterion: progress (`fraction`, 0 to 1), current activity (`doing`), and finally its verdict.

    `so_far`: a provisional result while it still waits (see `tutor.judge.events.Progress`).
    `before`: whether it was met in its last check before the app was started; None if it was never checked.
    """

    id: str
    text: str
    bonus: bool
    checking: bool = False
    fraction: float = 0.0
    doing: str = ""
    so_far: str = ""
    verdict: Verdict | None = None
    duration_s: float = 0.0
    before: bool | None = None


@dataclass(frozen=True, slots=True)
class Findings:
    """All criteria of one exercise, in display order. `note` says why there is no result, if there is none.

    `outdated`: whether the learner's code has changed since the check; None if that is not known. `before` is the time
    of the last check before the app was started, as in the progress file; empty if there was none. `at` is the time of
    the check that is shown, if that is one from before the app was started, whose findings were kept.
    """

    exercise: str
    criteria: tuple[Finding, ...]
    checking: bool = False
    result: ExerciseResult | None = None
    note: str = ""
    outdated: bool | None = None
    before: str = ""
    at: str = ""

    @classmethod
    def of(cls, lesson: Lesson) -> Findings:
        """Return the findings before any check."""
        return cls(lesson.id, tuple(Finding(c.id, c.text, c.bonus) for c in lesson.criteria))

    @property
    def judged(self) -> bool:
        """Whether there is a verdict to show."""
        return any(finding.verdict for finding in self.criteria)

    @property
    def fraction(self) -> float:
        """The progress of the whole check, 0 to 1."""
        done = [1.0 if finding.verdict else finding.fraction for finding in self.criteria if finding.checking]
        return sum(done) / len(done) if done else 0.0

    def with_check_started(self) -> Findings:
        """Return the findings at the start of a check, without the results of earlier ones."""
        fresh = tuple(Finding(f.id, f.text, f.bonus, checking=True, before=f.before) for f in self.criteria)
        return Findings(self.exercise, fresh, checking=True, before=self.before)

    def with_last_check(self, progress: ExerciseProgress) -> Findings:
        """Add the results of the last check in the progress file, unless there are verdicts or a check is running.

        The progress file holds no diagnoses, so verdicts are more informative.
        """
        if self.judged or self.checking or (last := progress.last) is None:
            return self
        met = last_met((f.id for f in self.criteria), progress)
        known = tuple(replace(f, before=met.get(f.id)) for f in self.criteria)
        return replace(self, criteria=known, before=last.at)

    def with_kept(self, last: LastCheck) -> Findings:
        """Show a check from before the app was started, unless there are verdicts or a check is running."""
        if self.judged or self.checking:
            return self
        return replace(self._with_verdicts(last.result), at=last.at)

    def with_event(self, event: Event) -> Findings:
        """Return the findings after `event`. An event of another exercise changes nothing."""
        match event:
            case CheckStarted(exercise, criteria) if exercise == self.exercise:
                known = {finding.id: finding for finding in self.criteria}
                shown = [known.get(id, Finding(id, id, bonus=False)) for id in criteria]
                rest = [replace(f, checking=False) for f in self.criteria if f.id not in criteria]
                return replace(self, criteria=(*(replace(f, checking=True) for f in shown), *rest))
            case Progress(exercise, criterion, fraction, doing, so_far) if exercise == self.exercise:
                return self._with_change(
                    criterion, lambda f: replace(f, checking=True, fraction=fraction, doing=doing, so_far=so_far)
                )
            case CriterionJudged(exercise, result) if exercise == self.exercise:
                return self._with_verdict(result)
            case ExerciseJudged(result) if result.id == self.exercise:
                return self._with_verdicts(result)
            case CheckFinished():
                return self.stopped()
        return self

    def stopped(self, note: str = "") -> Findings:
        """Return the findings after the check has finished or was cancelled: criteria without a verdict stay so."""

        def reset_unjudged(finding: Finding) -> Finding:
            if finding.verdict:
                return finding
            return replace(finding, checking=False, fraction=0.0, doing="", so_far="")

        return replace(self, criteria=tuple(map(reset_unjudged, self.criteria)), checking=False, note=note)

    def with_fault(self, what: str, hint: str, evidence: tuple[str, ...]) -> Findings:
        """Return the findings after a fault of the check itself: criteria without a verdict get an error verdict."""
        verdict = fault(what, hint, evidence)
        judged = tuple(f if f.verdict else replace(f, checking=True, verdict=verdict) for f in self.criteria)
        return replace(self, criteria=judged, checking=False, note="could not be judged")

    def _with_verdicts(self, result: ExerciseResult) -> Findings:
        findings = self
        for judged in result.criteria:
            findings = findings._with_verdict(judged)
        return replace(findings, result=result)

    def _with_verdict(self, result: CriterionResult) -> Findings:
        return self._with_change(
            result.id,
            lambda f: replace(
                f,
                text=result.text,
                bonus=result.bonus,
                checking=True,
                so_far="",
                verdict=result.verdict,
                duration_s=result.duration_s,
            ),
        )

    def _with_change(self, criterion: str, change: Callable[[Finding], Finding]) -> Findings:
        return replace(self, criteria=tuple(change(f) if f.id == criterion else f for f in self.criteria))
