"""Points: what each exercise and criterion is worth, from a teacher's `points.toml`.

A file that uses everything there is:

- `default = 10`: the points of an exercise without a table
- `[i1.1]` with `points = 20`: split in equal parts among the required criteria; `bonus = 1`: for each bonus criterion
- `[i1.1.criteria]` with `publishes = 2`, `rate = 3`: weights, by which the points are split instead; that of a bonus
  criterion is its number of points, beyond the others
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tutor.content import Course, Lesson
from tutor.errors import UsageError
from tutor.grade.results import Result
from tutor.judge.verdict import Status

DEFAULT_POINTS = 10.0
_DIGITS = 9


@dataclass(frozen=True, slots=True)
class CriterionScore:
    """The points of one criterion. `score` is None where a fault of the tool left it unjudged."""

    id: str
    score: float | None
    max_score: float
    bonus: bool


@dataclass(frozen=True, slots=True)
class Score:
    """The points of one exercise.

    `score` is None if a required criterion, or a bonus that is worth points, could not be judged: no points, no zero.
    """

    score: float | None
    max_score: float
    criteria: tuple[CriterionScore, ...]


@dataclass(frozen=True, slots=True)
class _Rule:
    """`weights` by criterion; what has none counts for nothing, unless no required criterion has one."""

    points: float
    bonus: float = 0.0
    weights: Mapping[str, float] = field(default_factory=dict)

    def required_weights(self, criteria: Sequence[str]) -> dict[str, float]:
        """Return the points of each of the required criteria."""
        weights = {name: self.weights.get(name, 0.0) for name in criteria}
        if not any(name in self.weights for name in criteria):
            weights = dict.fromkeys(criteria, 1.0)
        total = sum(weights.values())
        return {name: self.points * weight / total if total else 0.0 for name, weight in weights.items()}


class Points:
    """How many points a result is worth."""

    def __init__(self, default: float = DEFAULT_POINTS, rules: Mapping[str, _Rule] | None = None) -> None:
        self._default = default
        self._rules = dict(rules or {})

    @classmethod
    def read(cls, path: Path, course: Course) -> Points:
        """Read a `points.toml`. Raises UsageError, which names what is wrong in it."""
        try:
            document = tomllib.loads(path.read_text(encoding="utf-8-sig"))
        except OSError as error:
            raise UsageError(f"{path} cannot be read: {error.strerror}") from error
        except UnicodeDecodeError as error:
            raise UsageError(f"{path}: it is not UTF-8") from error
        except tomllib.TOMLDecodeError as error:
            raise UsageError(f"{path}: {error}") from error
        default = _number(document.pop("default", DEFAULT_POINTS), f"{path}: default")
        rules = {}
        for exercise, table in _tables(document):
            if not course.knows(exercise):
                raise UsageError(f"{path}: there is no exercise {exercise}")
            lesson = course.find(exercise)
            rules[lesson.id] = _read_rule(table, lesson, default, f"{path}: {exercise}")
        return cls(default, rules)

    def score(self, result: Result) -> Score:
        """Return the points of a result. A skipped criterion has none, as a failed one."""
        judged = result.judged
        rule = self._rules.get(result.exercise) or _Rule(self._default)
        if judged is None:
            return Score(None, rule.points, ())
        required = [criterion.id for criterion in judged.criteria if not criterion.bonus]
        weights = rule.required_weights(required)
        scores = []
        for criterion in judged.criteria:
            worth = rule.weights.get(criterion.id, rule.bonus) if criterion.bonus else weights[criterion.id]
            status = criterion.verdict.status
            unknown = status is Status.ERROR and not judged.missing and (worth > 0 or not criterion.bonus)
            score = None if unknown else worth if status is Status.PASSED else 0.0
            scores.append(CriterionScore(criterion.id, score, worth, criterion.bonus))
        known = [scored.score for scored in scores if scored.score is not None]
        # As sums of thirds are not whole.
        total = round(sum(known), _DIGITS) if len(known) == len(scores) else None
        return Score(total, rule.points, tuple(scores))


def _tables(document: Mapping[str, Any]) -> list[tuple[str, Any]]:
    """Return the tables of exercises: TOML reads [i1.1] as a table in a table, unless the name is quoted."""
    found: list[tuple[str, Any]] = []
    for name, table in document.items():
        is_nested = isinstance(table, dict) and table and all(isinstance(inner, dict) for inner in table.values())
        if is_nested and list(table) != ["criteria"]:
            found += _tables({f"{name}.{key}": inner for key, inner in table.items()})
        else:
            found.append((name, table))
    return found


def _read_rule(table: Any, lesson: Lesson, default: float, place: str) -> _Rule:
    if not isinstance(table, dict):
        raise UsageError(f"{place}: expected a table with points, bonus or criteria")
    for key in table:
        if key not in ("points", "bonus", "criteria"):
            raise UsageError(f"{place}: {key} is unknown; there are points, bonus and criteria")
    known = [criterion.id for criterion in lesson.criteria]
    weights = table.get("criteria", {})
    if not isinstance(weights, dict):
        raise UsageError(f"{place}: criteria: expected a table with a number for each criterion")
    for name in weights:
        if name not in known:
            raise UsageError(f"{place}: there is no criterion {name}; there are {', '.join(known)}")
    rule = _Rule(
        _number(table.get("points", default), f"{place}: points"),
        _number(table.get("bonus", 0.0), f"{place}: bonus"),
        {name: _number(value, f"{place}: {name}") for name, value in weights.items()},
    )
    required = [criterion.id for criterion in lesson.criteria if not criterion.bonus]
    if rule.points and not any(rule.required_weights(required).values()):
        raise UsageError(f"{place}: no required criterion has a weight above 0, so the points can never be reached")
    return rule


def _number(value: Any, place: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < math.inf:
        raise UsageError(f"{place}: expected a number of points, not {value!r}")
    return float(value)
