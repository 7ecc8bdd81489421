"""Phrases for evidence, such as "i2.1 validation passed, today"."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from datetime import date, datetime, timedelta

from tutor.report.assessment import AssessedExercise, Evidence, Source
from tutor.terminal_text import printable
from tutor.workspace import Help

_PREDICTIONS = "predictions"

Day = Callable[[str], str]
"""Formats the day of a time in the progress file (UTC, ISO 8601)."""


def calendar_day(at: str) -> str:
    """Return the local date, "2026-11-21", for documents that are read later; an invalid time as it is."""
    found = _local_date(at)
    return printable(at) if found is None else found.isoformat()


def near_day(at: str, today: date | None = None) -> str:
    """Return the local date relative to `today`: "today", "yesterday", or the date itself."""
    found = _local_date(at)
    if found is None:
        return printable(at)
    now = today or datetime.now().astimezone().date()
    return {now: "today", now - timedelta(days=1): "yesterday"}.get(found, found.isoformat())


def describe_evidence(evidence: Sequence[Evidence], day: Day, max_items: int | None = None) -> list[str]:
    """Return one phrase per exercise and day: "i2.1 runtime-params and timer passed with hints, today".

    What no longer holds says so: "i2.1 timer passed on 2026-11-20, since changed". If there are more than `max_items`,
    return the first `max_items`, followed by "N more".
    """
    together: dict[tuple[str, str], list[str]] = {}
    for piece in evidence:
        together.setdefault((piece.exercise, _describe_pass(piece, day)), []).append(_name_of(piece))
    phrases = [f"{_join_names(exercise, criteria)} {passed}" for (exercise, passed), criteria in together.items()]
    if max_items is None or len(phrases) <= max_items:
        return phrases
    return [*phrases[:max_items], f"{len(phrases) - max_items} more"]


def _describe_pass(evidence: Evidence, day: Day) -> str:
    passed, when = f"passed{describe_help(evidence.help)}", day(evidence.at)
    if evidence.holds or not when:
        return f"{passed}, {when}" if when else passed
    on = f"on {when}" if when[:1].isdecimal() else when
    return f"{passed} {on}, since changed" if evidence.changed else f"{passed} {on}"


def describe_help(help: Help | None) -> str:
    """Return what the learner had seen before, to follow "passed": " with hints"; empty if nothing, or not known."""
    return f" with {help}" if help is not None and help is not Help.NONE else ""


def describe_status(exercise: AssessedExercise) -> str:
    """Return the progress on an exercise: "passed with hints, 2026-11-20, since changed"."""
    if not exercise.passed:
        return exercise.status
    when = f", {calendar_day(exercise.passed_at)}" if exercise.passed_at else ""
    return f"passed{describe_help(exercise.help)}{when}{', since changed' if exercise.changed else ''}"


def describe_sources(sources: Sequence[Source]) -> list[str]:
    """Return one phrase per exercise that could give evidence: "i2.1 runtime-params and timer"."""
    return [
        _join_names(source.exercise, [_PREDICTIONS] if source.predictions else source.criteria) for source in sources
    ]


def _name_of(piece: Evidence) -> str:
    return _PREDICTIONS if piece.predictions else piece.criterion


def _join_names(exercise: str, criteria: Sequence[str]) -> str:
    named = [criterion for criterion in criteria if criterion]
    *others, last = named or [""]
    return f"{exercise} {', '.join(others)}{' and ' if others else ''}{last}".strip()


def _local_date(at: str) -> date | None:
    try:
        return datetime.fromisoformat(at).astimezone().date()
    except (ValueError, OverflowError):
        return None
