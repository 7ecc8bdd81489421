"""What the check of one exercise has found so far, built from its events. Plain data: no widget, no process."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from tutor.content import Lesson
from tutor.judge.events import CheckFinished, CheckStarted, CriterionJudged, Event, ExerciseJudged, Progress
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Verdict, fault
from tutor.workspace import ExerciseProgress, last_met


@dataclass(frozen=True, slots=True)
class Finding:
    """One criterion: how far its check is (`fraction`, 0 to 1), what is being done, and in the end its verdict.

    `so_far`: what is known while it still waits, not final (see `tutor.judge.events.Progress`).
    `before`: whether it was met when it was last checked before the app was started; None where it was not.
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
    """All criteria of one exercise, in the order to show them. `note` says why there is no result, if there is none.

    `outdated`: the learner's code is no longer what was checked. `before` is when it was last checked before the app
    was started, as the progress file has it; empty where it was not.
    """

    exercise: str
    criteria: tuple[Finding, ...]
    checking: bool = False
    result: ExerciseResult | None = None
    note: str = ""
    outdated: bool = False
    before: str = ""

    @classmethod
    def of(cls, lesson: Lesson) -> Findings:
        """Nothing found yet."""
        return cls(lesson.id, tuple(Finding(c.id, c.text, c.bonus) for c in lesson.criteria))

    @property
    def judged(self) -> bool:
        """Whether there is a verdict to show."""
        return any(finding.verdict for finding in self.criteria)

    @property
    def fraction(self) -> float:
        """How far the whole check is, 0 to 1."""
        done = [1.0 if finding.verdict else finding.fraction for finding in self.criteria if finding.checking]
        return sum(done) / len(done) if done else 0.0

    def begun(self) -> Findings:
        """A check begins: what an earlier one found is gone."""
        fresh = tuple(Finding(f.id, f.text, f.bonus, checking=True, before=f.before) for f in self.criteria)
        return Findings(self.exercise, fresh, checking=True, before=self.before)

    def with_last_check(self, progress: ExerciseProgress) -> Findings:
        """With what the progress file says of the last check; it holds no diagnosis, so our own verdict says more."""
        if self.judged or self.checking or (last := progress.last) is None:
            return self
        met = last_met((f.id for f in self.criteria), progress)
        known = tuple(replace(f, before=met.get(f.id)) for f in self.criteria)
        return replace(self, criteria=known, before=last.at)

    def after(self, event: Event) -> Findings:
        """What is known once `event` is. An event of another exercise changes nothing."""
        match event:
            case CheckStarted(exercise, criteria) if exercise == self.exercise:
                known = {finding.id: finding for finding in self.criteria}
                shown = [known.get(id, Finding(id, id, bonus=False)) for id in criteria]
                rest = [replace(f, checking=False) for f in self.criteria if f.id not in criteria]
                return replace(self, criteria=(*(replace(f, checking=True) for f in shown), *rest))
            case Progress(exercise, criterion, fraction, doing, so_far) if exercise == self.exercise:
                return self._with(
                    criterion, lambda f: replace(f, checking=True, fraction=fraction, doing=doing, so_far=so_far)
                )
            case CriterionJudged(exercise, result) if exercise == self.exercise:
                return self._judge(result)
            case ExerciseJudged(result) if result.id == self.exercise:
                found = self
                for judged in result.criteria:
                    found = found._judge(judged)
                return replace(found, result=result)
            case CheckFinished():
                return self.stopped()
        return self

    def stopped(self, note: str = "") -> Findings:
        """The check is over, or was cancelled: what has no verdict now gets none."""

        def idle(found: Finding) -> Finding:
            return found if found.verdict else replace(found, checking=False, fraction=0.0, doing="", so_far="")

        return replace(self, criteria=tuple(map(idle, self.criteria)), checking=False, note=note)

    def broken(self, what: str, hint: str, evidence: tuple[str, ...]) -> Findings:
        """The check itself failed: what has no verdict yet could not be judged, and that is our fault."""
        verdict = fault(what, hint, evidence)
        judged = tuple(f if f.verdict else replace(f, checking=True, verdict=verdict) for f in self.criteria)
        return replace(self, criteria=judged, checking=False, note="could not be judged")

    def _judge(self, result: CriterionResult) -> Findings:
        return self._with(
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

    def _with(self, criterion: str, change: Callable[[Finding], Finding]) -> Findings:
        return replace(self, criteria=tuple(change(f) if f.id == criterion else f for f in self.criteria))
