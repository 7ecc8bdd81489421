"""The stream of events of a check, which the terminal app and the command line both consume.

Events cross a process border as JSON, one to a line (`encode`, `decode`), so that a front end need not share a process
with ROS.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import Any

from tutor.judge.result import CriterionResult, Environment, ExerciseResult, Report, Wall
from tutor.judge.verdict import Status, Verdict


@dataclass(frozen=True, slots=True)
class CheckStarted:
    """A check of one exercise begins; `criteria` are the ids that will be judged, in the order to show them."""

    exercise: str
    criteria: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Progress:
    """How far one criterion is (`fraction`, 0 to 1), and what is being done to the node right now."""

    exercise: str
    criterion: str
    fraction: float
    doing: str


@dataclass(frozen=True, slots=True)
class CriterionJudged:
    """One criterion has its verdict."""

    exercise: str
    result: CriterionResult


@dataclass(frozen=True, slots=True)
class ExerciseJudged:
    """Every criterion of one exercise has its verdict."""

    result: ExerciseResult


@dataclass(frozen=True, slots=True)
class CheckFinished:
    """The last event of a check."""

    report: Report


Event = CheckStarted | Progress | CriterionJudged | ExerciseJudged | CheckFinished

_KINDS: dict[str, type[Event]] = {
    kind.__name__: kind for kind in (CheckStarted, Progress, CriterionJudged, ExerciseJudged, CheckFinished)
}


def encode(event: Event) -> str:
    """Write an event as one line of JSON, without the line's end.

    In ASCII: the same bytes in every locale, and no character that some reader would take for a line's end.
    """
    return json.dumps({"event": type(event).__name__, **_plain(asdict(event))})


def decode(line: str) -> Event:
    """Read an event that `encode` wrote.

    Raises ValueError for a line that is not an event.
    """
    try:
        fields = json.loads(line)
        kind = _KINDS[fields.pop("event")]
        event: Event = _BUILD[kind](fields)
        return event
    except (KeyError, TypeError, AttributeError, json.JSONDecodeError) as error:
        raise ValueError(f"not an event: {line[:200]!r}") from error


def _plain(value: Any) -> Any:
    if isinstance(value, Status):
        return value.value
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value


def _criterion(fields: dict[str, Any]) -> CriterionResult:
    verdict = fields.pop("verdict")
    return CriterionResult(
        **fields,
        verdict=Verdict(**{**verdict, "status": Status(verdict["status"]), "evidence": tuple(verdict["evidence"])}),
    )


def _exercise(fields: dict[str, Any]) -> ExerciseResult:
    return ExerciseResult(
        id=fields["id"],
        title=fields["title"],
        submission=tuple(fields["submission"]),
        criteria=tuple(_criterion(c) for c in fields["criteria"]),
        duration_s=fields["duration_s"],
    )


def _report(fields: dict[str, Any]) -> Report:
    return Report(
        environment=Environment(**fields["environment"]),
        exercises=tuple(_exercise(e) for e in fields["exercises"]),
        duration_s=fields["duration_s"],
        walls=tuple(Wall(**wall) for wall in fields["walls"]),
    )


_BUILD: dict[type[Event], Any] = {
    CheckStarted: lambda f: CheckStarted(f["exercise"], tuple(f["criteria"])),
    Progress: lambda f: Progress(**f),
    CriterionJudged: lambda f: CriterionJudged(f["exercise"], _criterion(f["result"])),
    ExerciseJudged: lambda f: ExerciseJudged(_exercise(f["result"])),
    CheckFinished: lambda f: CheckFinished(_report(f["report"])),
}
