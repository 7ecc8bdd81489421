"""One JSON document of check50 for each exercise of each learner (cs50/check50, docs/source/json_specification.rst)."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from tutor.grade.formats.feedback_text import fault_of
from tutor.grade.formats.json_document import points
from tutor.grade.gradebook import Gradebook
from tutor.grade.points import CriterionScore, Score
from tutor.grade.results import Result
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status
from tutor.report.plain import evidence_lines
from tutor.terminal_text import printable


def files(gradebook: Gradebook) -> dict[str, str]:
    """Return LEARNER/EXERCISE.check50.json for every result."""
    return {
        f"{result.learner.id}/{result.exercise}.check50.json": json.dumps(
            result_document(result, gradebook.points.score(result), steps=gradebook.steps),
            ensure_ascii=False,
            indent=4,
            allow_nan=False,
        )
        + "\n"
        for learner in gradebook.learners
        for result in gradebook.results_of(learner)
    }


def result_document(result: Result, score: Score, *, steps: bool = True) -> dict[str, Any]:
    """Return the document of a result. `passed` is null for what was skipped or could not be judged."""
    judged = result.judged
    found: Mapping[str, Any] = (
        {"error": _error(fault_of(result))}
        if judged is None
        else {
            "results": [
                _check(judged, criterion, worth, steps)
                for criterion, worth in zip(judged.criteria, score.criteria, strict=True)
            ]
        }
    )
    return {"slug": f"ros-tutor/{result.exercise}", **found, "version": result.version.ros_tutor}


def _check(exercise: ExerciseResult, criterion: CriterionResult, score: CriterionScore, steps: bool) -> dict[str, Any]:
    verdict = criterion.verdict
    data = {
        "bonus": criterion.bonus,
        "score": points(score.score),
        "max_score": points(score.max_score),
        "mistake": verdict.mistake or None,
        "same_as": verdict.same_as or None,
    }
    return {
        "name": criterion.id,
        "description": criterion.text,
        "passed": _passed(exercise, criterion),
        "log": evidence_lines(verdict),
        "cause": None if verdict.passed else _cause(exercise, criterion, steps),
        "data": data,
        "dependency": None,
    }


def _passed(exercise: ExerciseResult, criterion: CriterionResult) -> bool | None:
    if exercise.missing:
        return False
    return {Status.PASSED: True, Status.FAILED: False}.get(criterion.verdict.status)


def _cause(exercise: ExerciseResult, criterion: CriterionResult, steps: bool) -> dict[str, Any]:
    verdict = criterion.verdict
    unjudged = verdict.status is Status.ERROR and not exercise.missing
    document: dict[str, Any] = {
        "rationale": printable(verdict.cause or verdict.observed or verdict.status.value),
        "help": printable(verdict.step) or None if steps and verdict.status is Status.FAILED else None,
    }
    if unjudged:
        document["error"] = _error(verdict.cause)
    elif verdict.expected and verdict.observed:
        document |= {"expected": printable(verdict.expected), "actual": printable(verdict.observed)}
    return document


def _error(what: str) -> dict[str, Any]:
    return {"type": "NotJudged", "value": printable(what), "traceback": [], "data": {}}
