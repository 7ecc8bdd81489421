"""What Classroom 50 reads of an autograder, result.json (foundation50/classroom50, schemas/result-v1.schema.json)."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from typing import Any

from tutor.errors import UsageError
from tutor.grade.formats.feedback_text import criterion_text
from tutor.grade.gradebook import Gradebook
from tutor.grade.learners import Learner
from tutor.grade.points import CriterionScore, Points, Score
from tutor.grade.results import Result
from tutor.judge.result import CriterionResult, ExerciseResult

SCHEMA = "classroom50/result/v1"

_MAX_FACTOR = 100


def files(gradebook: Gradebook) -> dict[str, str]:
    """Return LEARNER/result.json for every learner, with all exercises."""
    return {
        f"{learner.id}/result.json": json.dumps(
            result_document(
                gradebook.results_of(learner),
                gradebook.points,
                _environ(gradebook, learner),
                steps=gradebook.steps,
            ),
            ensure_ascii=False,
            indent=2,
        )
        + "\n"
        for learner in gradebook.learners
    }


def result_document(
    results: Sequence[Result], points: Points, environ: Mapping[str, str], *, steps: bool = True
) -> dict[str, Any]:
    """Return the document for the results of one learner; `environ` is what Classroom 50's runner sets.

    It takes integers, and no more points than the maximum. So where a criterion is worth a fraction of a point, all
    points are multiplied by the smallest number that makes them whole: thirds of 10 points become 10 of 30. A bonus
    makes up for points lost elsewhere, and is listed only if it passed, since any other test would fail the submission.
    An exercise that a fault of the tool left unjudged is left out, with its maximum. Raises UsageError if a variable is
    missing.
    """
    judged = [
        (result.judged, score)
        for result in results
        if result.judged is not None and (score := points.score(result)).score is not None
    ]
    factor = _factor([score for _, score in judged])
    tests = [
        _test(exercise, criterion, worth, factor, steps)
        for exercise, score in judged
        for criterion, worth in zip(exercise.criteria, score.criteria, strict=True)
        if criterion.verdict.passed or not criterion.bonus
    ]
    max_score = sum(test["max-score"] for test in tests)
    bonus = sum(worth.score or 0.0 for _, score in judged for worth in score.criteria if worth.bonus)
    graded_at = _utc(max((result.graded_at for result in results), default=""))
    return {
        "schema": SCHEMA,
        "classroom": _variable(environ, "CLASSROOM"),
        "assignment": _variable(environ, "ASSIGNMENT"),
        "assignment_type": environ.get("ASSIGNMENT_TYPE") or "individual",
        "owner": _variable(environ, "OWNER", "USERNAME"),
        "submission": _variable(environ, "SUBMISSION_TAG"),
        "commit": _variable(environ, "COMMIT_URL"),
        "release": _variable(environ, "RELEASE_URL"),
        "review": _variable(environ, "REVIEW_URL", "COMMIT_URL"),
        "datetime": graded_at,
        "graded_at": graded_at,
        "score": min(max_score, sum(test["score"] for test in tests) + round(bonus * factor)),
        "max-score": max_score,
        "tests": tests,
    }


def _test(
    exercise: ExerciseResult, criterion: CriterionResult, worth: CriterionScore, factor: int, steps: bool
) -> dict[str, Any]:
    max_score = 0 if criterion.bonus else round(worth.max_score * factor)
    return {
        "test-name": f"{exercise.id} {criterion.id}{' (bonus)' if criterion.bonus else ''}",
        "passed": criterion.verdict.passed,
        "score": max_score if criterion.verdict.passed else 0,
        "max-score": max_score,
        "output": criterion_text(exercise, criterion, steps=steps),
    }


def _factor(scores: Sequence[Score]) -> int:
    worths = [worth.max_score for score in scores for worth in score.criteria if not worth.bonus]
    return next(
        (
            factor
            for factor in range(1, _MAX_FACTOR)
            if all(abs(worth * factor - round(worth * factor)) < 1e-6 for worth in worths)
        ),
        _MAX_FACTOR,
    )


def _variable(environ: Mapping[str, str], *names: str) -> str:
    value = next((environ[name] for name in names if environ.get(name)), "")
    if not value:
        raise UsageError(f"Classroom 50's runner sets {' or '.join(names)}, which is not set here")
    return value


def _utc(at: str) -> str:
    moment = datetime.fromisoformat(at).astimezone(UTC) if at else datetime.now(UTC)
    return moment.strftime("%Y-%m-%dT%H:%M:%SZ")


def _environ(gradebook: Gradebook, learner: Learner) -> dict[str, str]:
    """Return what the runner would set, as far as it is known outside of Classroom 50: the files have a digest only."""
    results = gradebook.results_of(learner)
    digest = next((result.digest for result in results if result.digest), "") or "none"
    moment = _utc(max(result.graded_at for result in results)).replace(":", "-")
    return {
        "CLASSROOM": gradebook.title,
        "ASSIGNMENT": " ".join(lesson.id for lesson in gradebook.lessons),
        "OWNER": learner.id,
        "SUBMISSION_TAG": f"submit/{moment}-{digest[:7]}",
        "COMMIT_URL": f"sha256:{digest}",
        "RELEASE_URL": f"sha256:{digest}",
    }
