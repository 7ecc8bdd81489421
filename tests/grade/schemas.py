"""The part of JSON Schema that the schemas of the systems around a class use, and these schemas."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

_TYPES: Mapping[str, type | tuple[type, ...]] = {
    "object": dict,
    "array": list,
    "string": str,
    "boolean": bool,
    "integer": int,
    "number": (int, float),
    "null": type(None),
}


def assert_valid(document: Any, schema: Mapping[str, Any], place: str = "$") -> None:
    """Fail unless `document` is as `schema` says; unlike JSON Schema, a schema of an object is of all its members."""
    if "const" in schema:
        assert document == schema["const"], place
    if "enum" in schema:
        assert document in schema["enum"], place
    if "type" in schema:
        wanted = schema["type"] if isinstance(schema["type"], list) else [schema["type"]]
        assert any(_is(document, name) for name in wanted), f"{place}: {document!r} is none of {wanted}"
    if isinstance(document, str):
        assert len(document) >= schema.get("minLength", 0), place
        assert re.search(schema.get("pattern", ""), document), place
    if isinstance(document, int | float):
        assert document >= schema.get("minimum", document), place
    if isinstance(document, list):
        for index, item in enumerate(document):
            assert_valid(item, schema.get("items", {}), f"{place}[{index}]")
    if isinstance(document, dict):
        properties = schema.get("properties", {})
        assert set(schema.get("required", ())) <= set(document), place
        assert schema.get("additionalProperties", False) or set(document) <= set(properties), f"{place}: {document}"
        for name, value in document.items():
            assert_valid(value, properties.get(name, {}), f"{place}.{name}")


def _is(value: Any, name: str) -> bool:
    return isinstance(value, _TYPES[name]) and (not isinstance(value, bool) or name == "boolean")


_TEXT = {"type": "string"}
_NAME = {"type": "string", "minLength": 1}
_COUNT = {"type": "integer", "minimum": 0}
_POINTS = {"type": "number", "minimum": 0}
_MAYBE_POINTS = {"type": ["number", "null"], "minimum": 0}
_MAYBE_TEXT = {"type": ["string", "null"]}
_FLAG = {"type": "boolean"}


def _object(properties: Mapping[str, Any], *optional: str, more: bool = False) -> dict[str, Any]:
    required = [name for name in properties if name not in optional]
    return {"type": "object", "properties": properties, "required": required, "additionalProperties": more}


def _list(items: Mapping[str, Any]) -> dict[str, Any]:
    return {"type": "array", "items": items}


_FORMAT = {"enum": ["text", "html", "simple_format", "md", "ansi"]}
_VISIBILITY = {"enum": ["hidden", "after_due_date", "after_published", "visible"]}
_GRADESCOPE_TEST = {
    "score": _POINTS,
    "max_score": _POINTS,
    "status": {"enum": ["passed", "failed"]},
    "name": _NAME,
    "name_format": _FORMAT,
    "number": _TEXT,
    "output": _TEXT,
    "output_format": _FORMAT,
    "tags": _list(_TEXT),
    "visibility": _VISIBILITY,
    "extra_data": {"type": "object", "additionalProperties": True},
}
_GRADESCOPE = {
    "score": _POINTS,
    "execution_time": _POINTS,
    "output": _TEXT,
    "output_format": _FORMAT,
    "test_output_format": _FORMAT,
    "test_name_format": _FORMAT,
    "visibility": _VISIBILITY,
    "stdout_visibility": _VISIBILITY,
    "extra_data": {"type": "object", "additionalProperties": True},
    "tests": _list(_object(_GRADESCOPE_TEST, *_GRADESCOPE_TEST)),
    "leaderboard": _list({"type": "object", "additionalProperties": True}),
}
GRADESCOPE = _object(_GRADESCOPE, *(name for name in _GRADESCOPE if name not in ("score", "tests")))
"""gradescope/autograder_samples, docs/specs.md; a score at the top, as we always have one."""

_MOMENT = {"type": "string", "pattern": r"^\d{4}-\d\d-\d\dT([01]\d|2[0-3]):[0-5]\d:[0-5]\dZ$"}
_CLASSROOM50_TEST = {"test-name": _NAME, "passed": _FLAG, "score": _COUNT, "max-score": _COUNT}
CLASSROOM50 = _object(
    {
        "schema": {"const": "classroom50/result/v1"},
        "classroom": _NAME,
        "assignment": _NAME,
        "assignment_type": {"enum": ["individual", "group", "team"]},
        "owner": _NAME,
        "submission": {"type": "string", "pattern": "^submit/"},
        "commit": _NAME,
        "release": _NAME,
        "review": _NAME,
        "datetime": _MOMENT,
        "graded_at": _MOMENT,
        "score": _COUNT,
        "max-score": _COUNT,
        "tests": _list(_object(_CLASSROOM50_TEST, more=True)),
    },
    "graded_at",
)
"""foundation50/classroom50, schemas/result-v1.schema.json."""

_CHECK50_ERROR = _object({"type": _NAME, "value": _TEXT, "traceback": _list(_TEXT), "data": {"type": "object"}})
_CHECK50_CAUSE = {"rationale": _NAME, "help": _MAYBE_TEXT, "expected": _TEXT, "actual": _TEXT, "error": _CHECK50_ERROR}
_CHECK50_RESULT = {
    "name": _NAME,
    "description": _NAME,
    "passed": {"type": ["boolean", "null"]},
    "log": _list({"type": "string", "pattern": r"^[^\n]*$"}),
    "cause": {**_object(_CHECK50_CAUSE, "help", "expected", "actual", "error"), "type": ["object", "null"]},
    "data": {"type": "object", "additionalProperties": True},
    "dependency": _MAYBE_TEXT,
}
_CHECK50 = {"slug": _NAME, "version": _NAME}
CHECK50 = _object(_CHECK50 | {"results": _list(_object(_CHECK50_RESULT))})
CHECK50_ERROR = _object(_CHECK50 | {"error": _CHECK50_ERROR})
"""cs50/check50, docs/source/json_specification.rst."""

_GRADES_CRITERION = {
    "id": _NAME,
    "bonus": _FLAG,
    "status": {"enum": ["passed", "failed", "skipped", "error"]},
    "score": _MAYBE_POINTS,
    "max_score": _POINTS,
    "mistake": _MAYBE_TEXT,
    "same_as": _MAYBE_TEXT,
    "cause": _TEXT,
    "step": _TEXT,
}
_GRADES_EXERCISE = {
    "id": _NAME,
    "status": {"enum": ["passed", "failed", "missing", "error"]},
    "score": _MAYBE_POINTS,
    "max_score": _POINTS,
    "message": _TEXT,
    "graded_at": _NAME,
    "digest": _TEXT,
    "attempt": {"type": "integer", "minimum": 1},
    "mistakes": _list(_NAME),
    "criteria": _list(_object(_GRADES_CRITERION, "step")),
}
_GRADES_LEARNER = {
    "id": _NAME,
    "name": _NAME,
    "number": _TEXT,
    "email": _TEXT,
    "score": _POINTS,
    "max_score": _POINTS,
    "complete": _FLAG,
    "exercises": _list(_object(_GRADES_EXERCISE)),
}
GRADES = _object(
    {
        "schema": {"const": "ros-tutor/grades/1"},
        "title": _TEXT,
        "exercises": _list(
            _object(
                {
                    "id": _NAME,
                    "title": _NAME,
                    "max_score": _POINTS,
                    "criteria": _list(_object({"id": _NAME, "text": _NAME, "bonus": _FLAG})),
                    "mistakes": _list(_object({"id": _NAME, "name": _NAME, "learners": _COUNT})),
                }
            )
        ),
        "learners": _list(_object(_GRADES_LEARNER)),
    }
)
"""Our own `ros-tutor/grades/1`."""
