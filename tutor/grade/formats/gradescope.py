"""What Gradescope reads of an autograder, results.json (gradescope/autograder_samples, docs/specs.md)."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from tutor.grade.formats.feedback_text import FAULT, criterion_text, exercise_text, fault_of
from tutor.grade.gradebook import Gradebook
from tutor.grade.points import CriterionScore, Points
from tutor.grade.results import Result
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.report.plain import one_line

ERROR_NAME = "Autograder error"


def files(gradebook: Gradebook) -> dict[str, str]:
    """Return LEARNER/results.json for every learner, with all exercises."""
    documents = {
        learner.id: results_document(gradebook.results_of(learner), gradebook.points, steps=gradebook.steps)
        for learner in gradebook.learners
    }
    return {
        f"{learner}/results.json": json.dumps(document, ensure_ascii=False, indent=2, allow_nan=False) + "\n"
        for learner, document in documents.items()
    }


def results_document(results: Sequence[Result], points: Points, *, steps: bool = True) -> dict[str, Any]:
    """Return the document for the results of one learner.

    Gradescope wants a score. A fault of the tool is no zero of the learner's, so what it left unjudged counts nothing,
    has no scores of its own, and a visible test says what happened. While another test is hidden, which only
    instructors see, Gradescope shows learners no total.
    """
    scores = [points.score(result) for result in results]
    tests = []
    for result, score in zip(results, scores, strict=True):
        if result.judged is not None:
            for criterion, worth in zip(result.judged.criteria, score.criteria, strict=True):
                tests.append(_test(result.judged, criterion, worth if score.score is not None else None, steps))
    faults = [f"{result.exercise}: {fault_of(result)}" for result in results if result.status == "error"]
    if faults:
        tests = [*_errors(faults), *tests]
    return {
        "score": round(sum(score.score or 0.0 for score in scores), 2),
        "execution_time": round(sum(result.report.duration_s for result in results), 1),
        "output": "\n\n".join(
            exercise_text(result, score, steps=steps) for result, score in zip(results, scores, strict=True)
        ),
        "output_format": "text",
        "test_output_format": "text",
        "test_name_format": "text",
        "visibility": "visible",
        "stdout_visibility": "hidden",
        "tests": tests,
    }


def _test(
    exercise: ExerciseResult, criterion: CriterionResult, score: CriterionScore | None, steps: bool
) -> dict[str, Any]:
    bonus = " (bonus)" if criterion.bonus else ""
    worth = (
        {"score": round(score.score, 2), "max_score": round(score.max_score, 2)}
        if score is not None and score.score is not None and score.max_score
        else {}
    )
    return {
        **worth,
        "status": "passed" if criterion.verdict.passed else "failed",
        "name": one_line(f"{exercise.id} {criterion.id}{bonus}: {criterion.text}"),
        "output": criterion_text(exercise, criterion, steps=steps),
        "visibility": "visible",
    }


def _errors(faults: Sequence[str]) -> list[dict[str, Any]]:
    what = f"Not everything could be judged: {FAULT}. There is no score until the autograder has run again."
    return [
        {"status": "failed", "name": ERROR_NAME, "output": what, "visibility": "visible"},
        {
            "status": "failed",
            "name": f"{ERROR_NAME}: for instructors",
            "output": "\n".join(faults),
            "visibility": "hidden",
        },
    ]
