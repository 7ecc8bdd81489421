"""The checklist as a JSON document, for programs. All times are UTC in ISO 8601."""

from __future__ import annotations

import json
from typing import Any

from tutor.report.assessment import AssessedExercise, AssessedGroup, AssessedItem, Assessment

SCHEMA = "ros-tutor/checklist/1"


def render(assessment: Assessment, *, at: str) -> str:
    """Render the document as JSON text with a final newline."""
    document = {
        "schema": SCHEMA,
        "exported_at": at,
        "ticked": assessment.ticked,
        "total": len(assessment.items),
        "ready": assessment.ready,
        "groups": [_group(group) for group in assessment.groups],
        "exercises": [_exercise(exercise) for exercise in assessment.exercises],
    }
    return json.dumps(document, ensure_ascii=False, indent=2, allow_nan=False) + "\n"


def _group(group: AssessedGroup) -> dict[str, Any]:
    return {
        "id": group.id,
        "title": group.title,
        "ticked": group.ticked,
        "total": len(group.items),
        "items": [_item(item) for item in group.items],
    }


def _item(item: AssessedItem) -> dict[str, Any]:
    return {
        "id": item.id,
        "text": item.text,
        "ticked": item.ticked,
        "ticked_at": item.ticked_at,
        "evidence": [
            {
                "exercise": piece.exercise,
                "criterion": piece.criterion or None,
                "predictions": list(piece.predictions),
                "passed_at": piece.at or None,
                "since_changed": piece.changed,
                "help": piece.help,
            }
            for piece in item.evidence
        ],
    }


def _exercise(exercise: AssessedExercise) -> dict[str, Any]:
    return {
        "id": exercise.id,
        "title": exercise.title,
        "difficulty": exercise.difficulty,
        "beyond": exercise.beyond,
        "standing": exercise.status,
        "passed": exercise.passed,
        "passed_at": exercise.passed_at,
        "since_changed": exercise.changed if exercise.passed else None,
        "help": exercise.help,
        "criteria": {"passed": exercise.met, "total": exercise.required},
        "bonus": {"passed": exercise.bonus_met, "total": exercise.bonus},
        "attempts": exercise.attempts,
        "last_attempt_at": exercise.last_at,
    }
