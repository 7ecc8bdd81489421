"""The grades as a JSON document, for programs: the points, and why each criterion was not met."""

from __future__ import annotations

import json
from typing import Any

from tutor.grade.gradebook import Gradebook
from tutor.grade.learners import Learner
from tutor.grade.points import CriterionScore, Score
from tutor.grade.results import Result
from tutor.judge.result import CriterionResult
from tutor.terminal_text import printable

SCHEMA = "ros-tutor/grades/1"


def render(gradebook: Gradebook, template: str | None = None) -> str:
    """Render the document. A `score` is null where a fault of the tool left the work unjudged."""
    document = {
        "schema": SCHEMA,
        "title": printable(gradebook.title),
        "exercises": [
            {
                "id": lesson.id,
                "title": lesson.title,
                "max_score": points(gradebook.max_score(lesson)),
                "criteria": [
                    {"id": criterion.id, "text": criterion.text, "bonus": criterion.bonus}
                    for criterion in lesson.criteria
                ],
                "mistakes": [
                    {"id": mistake, "name": printable(name), "learners": count}
                    for mistake, name, count in gradebook.mistakes(lesson)
                ],
            }
            for lesson in gradebook.lessons
        ],
        "learners": [_learner(gradebook, learner) for learner in gradebook.learners],
    }
    return json.dumps(document, ensure_ascii=False, indent=1, allow_nan=False) + "\n"


def points(value: float | None) -> float | None:
    """Round a number of points, for a document."""
    return None if value is None else round(value, 2)


def _learner(gradebook: Gradebook, learner: Learner) -> dict[str, Any]:
    total = gradebook.total(learner)
    return {
        "id": printable(learner.id),
        "name": printable(learner.name),
        "number": printable(learner.number),
        "email": printable(learner.email),
        "score": points(total.score),
        "max_score": points(total.max_score),
        "complete": total.complete,
        "exercises": [
            _exercise(result, gradebook.points.score(result), gradebook.steps)
            for result in gradebook.results_of(learner)
        ],
    }


def _exercise(result: Result, score: Score, steps: bool) -> dict[str, Any]:
    judged = result.judged
    criteria = judged.criteria if judged is not None else ()
    return {
        "id": result.exercise,
        "status": result.status,
        "score": points(score.score),
        "max_score": points(score.max_score),
        "message": printable(judged.missing if judged is not None else result.report.message),
        "graded_at": result.graded_at,
        "digest": result.digest,
        "attempt": result.attempt,
        "mistakes": list(judged.mistakes if judged is not None else ()),
        "criteria": [
            _criterion(criterion, worth, steps) for criterion, worth in zip(criteria, score.criteria, strict=True)
        ],
    }


def _criterion(criterion: CriterionResult, score: CriterionScore, steps: bool) -> dict[str, Any]:
    verdict = criterion.verdict
    document = {
        "id": criterion.id,
        "bonus": criterion.bonus,
        "status": verdict.status.value,
        "score": points(score.score),
        "max_score": points(score.max_score),
        "mistake": verdict.mistake or None,
        "same_as": verdict.same_as or None,
        "cause": printable(verdict.cause),
    }
    return document | {"step": printable(verdict.step)} if steps else document
