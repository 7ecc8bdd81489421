"""The report as a JSON document, for programs."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from tutor.judge.result import CriterionResult, Environment, ExerciseResult, Lookup, Remark, Report, Restriction
from tutor.judge.verdict import Status, Verdict
from tutor.terminal_text import printable

SCHEMA = "ros-tutor/report/1"


def render(report: Report) -> str:
    """Render the document; durations are in seconds, rounded to milliseconds."""
    document: dict[str, Any] = {
        "schema": SCHEMA,
        "verdict": report.verdict.value,
        **({"message": printable(report.message)} if report.message else {}),
        "duration_s": round(report.duration_s, 3),
        "environment": asdict(report.environment),
        "exercises": [_exercise(exercise) for exercise in report.exercises],
    }
    if report.isolation:
        document["walls"] = [asdict(wall) for wall in report.isolation]
    return json.dumps(document, ensure_ascii=False, indent=2, allow_nan=False) + "\n"


def parse(document: Mapping[str, Any]) -> Report:
    """Return the report that `render` wrote as this document. Raises ValueError.

    What the document does not hold is empty: digests, the criteria met by the skeleton's code, checklist items.
    """
    try:
        if document["schema"] != SCHEMA:
            raise ValueError(f"not a {SCHEMA}")
        return Report(
            environment=Environment(**document["environment"]),
            exercises=tuple(_parse_exercise(exercise) for exercise in document["exercises"]),
            duration_s=document["duration_s"],
            isolation=tuple(Restriction(**wall) for wall in document.get("walls", ())),
            message=document.get("message", ""),
        )
    except (KeyError, TypeError) as error:
        raise ValueError("it is damaged") from error


def _parse_exercise(document: Mapping[str, Any]) -> ExerciseResult:
    missing = document.get("missing")
    return ExerciseResult(
        id=document["id"],
        title=document["title"],
        submission=tuple(document["submission"]),
        criteria=tuple(_parse_criterion(criterion) for criterion in document["criteria"]),
        duration_s=document["duration_s"],
        remarks=tuple(Remark(**remark) for remark in document["remarks"]),
        lookup=Lookup(tuple(missing["looked_for"]), tuple(missing["found"])) if missing else None,
    )


def _parse_criterion(document: Mapping[str, Any]) -> CriterionResult:
    verdict = Verdict(
        Status(document["status"]),
        expected=document["expected"],
        observed=document["observed"],
        cause=document["cause"],
        step=document["step"],
        evidence=tuple(document["evidence"]),
        mistake=document["mistake"] or "",
        same_as=document["same_as"] or "",
    )
    return CriterionResult(document["id"], document["text"], document["bonus"], verdict, document["duration_s"])


def _exercise(exercise: ExerciseResult) -> dict[str, Any]:
    return {
        "id": exercise.id,
        "title": exercise.title,
        "verdict": exercise.verdict.value,
        "duration_s": round(exercise.duration_s, 3),
        "submission": list(exercise.submission),
        **({"missing": _missing(exercise)} if exercise.missing else {}),
        "criteria": [_criterion(criterion) for criterion in exercise.criteria],
        "remarks": [
            {"mistake": remark.mistake, "text": printable(remark.text), "file": remark.file, "line": remark.line}
            for remark in exercise.remarks
        ],
    }


def _missing(exercise: ExerciseResult) -> dict[str, Any]:
    lookup = exercise.lookup
    return {
        "message": printable(exercise.missing),
        "looked_for": [] if lookup is None else [printable(path) for path in lookup.looked_for],
        "found": [] if lookup is None else [printable(name) for name in lookup.found],
    }


def _criterion(criterion: CriterionResult) -> dict[str, Any]:
    verdict = criterion.verdict
    return {
        "id": criterion.id,
        "text": criterion.text,
        "bonus": criterion.bonus,
        "status": verdict.status.value,
        "duration_s": round(criterion.duration_s, 3),
        "expected": printable(verdict.expected),
        "observed": printable(verdict.observed),
        "mistake": verdict.mistake or None,
        "cause": printable(verdict.cause),
        "step": printable(verdict.step),
        "same_as": verdict.same_as or None,
        "evidence": [printable(line) for line in verdict.evidence],
    }
