"""What an author is told where a verdict is not as expect.yaml says."""

from __future__ import annotations

from tutor.content.expectations import find_deviations
from tutor.content.submissions import Expected
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status, Verdict, passed, skipped


def judged(*verdicts: Verdict) -> ExerciseResult:
    criteria = [CriterionResult(f"c{at}", f"c{at}", False, verdict, 0.0) for at, verdict in enumerate(verdicts)]
    return ExerciseResult("x1.1", "Title", ("mover.py",), tuple(criteria), 0.0)


def test_what_is_skipped_for_a_criterion_without_a_verdict_is_not_told_again() -> None:
    error = Verdict(Status.ERROR, "it moves", cause="the check itself failed")
    result = judged(error, skipped("not judged, because `c0` did not pass"), passed("it stops", "it does"))
    assert [deviation.text for deviation in find_deviations(Expected("right", passes=True), result)] == [
        "not judged: c0 error: the check itself failed"
    ]
