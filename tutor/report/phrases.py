"""Phrases for evidence, such as "i2.1 validation passed, today"."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from datetime import date, datetime, timedelta

from tutor.report.assessment import Evidence, Source
from tutor.terminal_text import printable

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
    """Return one phrase per exercise and day: "i2.1 runtime-params and timer passed, today".

    If there are more than `max_items`, return the first `max_items`, followed by "N more".
    """
    criteria_by_day: dict[tuple[str, str], list[str]] = {}
    for each in evidence:
        criteria_by_day.setdefault((each.exercise, day(each.at)), []).append(each.criterion)
    phrases = [
        f"{_join_names(exercise, criteria)} passed{f', {when}' if when else ''}"
        for (exercise, when), criteria in criteria_by_day.items()
    ]
    if max_items is None or len(phrases) <= max_items:
        return phrases
    return [*phrases[:max_items], f"{len(phrases) - max_items} more"]


def describe_sources(sources: Sequence[Source]) -> list[str]:
    """Return one phrase per exercise that could give evidence: "i2.1 runtime-params and timer"."""
    return [_join_names(source.exercise, source.criteria) for source in sources]


def _join_names(exercise: str, criteria: Sequence[str]) -> str:
    named = [criterion for criterion in criteria if criterion]
    *others, last = named or [""]
    return f"{exercise} {', '.join(others)}{' and ' if others else ''}{last}".strip()


def _local_date(at: str) -> date | None:
    try:
        return datetime.fromisoformat(at).astimezone().date()
    except (ValueError, OverflowError):
        return None
